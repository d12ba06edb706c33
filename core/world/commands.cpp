// Applying commands: checked against state and rights, then applied, or rejected with a reason.
// Both are functions of (state, commands) alone.

#include <algorithm>
#include <optional>
#include <utility>

#include "core/math/finite.h"
#include "core/math/trig.h"
#include "core/rules/rules.h"
#include "core/scene/in_double.h"
#include "core/world/world_data.h"

namespace huestep {

namespace {

constexpr float pushSlack = 1.0f;  // m, how far beside a body a player may push it
constexpr float grabHertz = 5.0f;  // soft enough not to shake what is held
constexpr float grabDamping = 0.7f;

/// A speed that a body may have; not so for NaN.
bool slow(float v) {
    return v >= -maxSpeed && v <= maxSpeed;
}

bool inWorld(Vec2 p) {
    const auto in = [](float v) { return v >= -maxCoordinate && v <= maxCoordinate; };
    return isFinite(p) && in(p.x) && in(p.y);
}

/// Whether the numbers of an action are finite; those of a definition the world judges as a whole.
bool hasFiniteNumbers(const Action& action) {
    const auto fine = []<class A>(const A& a) {
        if constexpr (requires { a.impulse; })
            return isFinite(a.impulse) && isFinite(a.point);
        else if constexpr (requires { a.force; })
            return isFinite(a.force) && isFinite(a.point);
        else if constexpr (std::is_same_v<A, Grab>)
            return isFinite(a.point) && isFinite(a.target);
        else if constexpr (std::is_same_v<A, MoveGrab>)
            return isFinite(a.target);
        else if constexpr (std::is_same_v<A, SetMotor>)
            return isFinite(a.speed);
        else if constexpr (std::is_same_v<A, Custom>)
            return isFinite(a.vector);
        else
            return true;
    };
    return std::visit(fine, action);
}

}  // namespace

/// One tick's commands against one world. Each `apply` either does all of its command or nothing.
class Applier {
 public:
    Applier(World::Data& world) : m_world(world), m_state(world.state) {}

    CommandOutcome apply(const Command& command) {
        CommandOutcome outcome{command.author, command.sequence, Rejection::None, 0};
        PlayerRecord* author = m_world.findPlayer(command.author);
        if (author == nullptr) {
            outcome.reason = Rejection::UnknownAuthor;
            return outcome;
        }
        if (command.sequence <= author->lastSequence) {
            outcome.reason = Rejection::OldSequence;
            return outcome;
        }
        author->lastSequence = command.sequence;
        if (command.author != 0 && ++m_fromPlayers > m_state.info().maxCommandsPerTick) {
            outcome.reason = Rejection::OverLimit;
            return outcome;
        }
        m_author = command.author;
        m_firstBody = 0;
        outcome.reason = judgeByRules(command);
        if (outcome.reason == Rejection::None) {
            outcome.reason =
                std::visit([this](const auto& action) { return apply(action); }, command.action);
        }
        outcome.firstBody = m_firstBody;
        return outcome;
    }

    /// For the rules, while a command is judged or after all of them.
    RulesOutcome act(const RulesAction& action, PlayerId as) {
        if (!m_world.findPlayer(as)) return {Rejection::UnknownAuthor, 0};
        const PlayerId author = std::exchange(m_author, as);
        const BodyId firstBody = std::exchange(m_firstBody, 0);
        RulesOutcome outcome;
        outcome.reason = std::visit([this](const auto& a) { return apply(a); }, action);
        outcome.firstBody = std::exchange(m_firstBody, firstBody);
        m_author = author;
        return outcome;
    }

    RulesOutcome respawn(PlayerId id, Vec2 position) {
        PlayerRecord* player = m_world.findPlayer(id);
        if (id == 0 || player == nullptr) return {Rejection::UnknownAuthor, 0};
        if (m_state.playerBody.empty()) return {Rejection::NotAllowed, 0};
        if (!inWorld(position)) return {Rejection::NotFinite, 0};
        if (!roomFor(1, m_state.playerShapes.size(), 0)) return {Rejection::OverLimit, 0};
        if (const auto place = m_world.findBody(player->body)) markBody(*place);
        player->body = addPlayerBody(id, position);
        return {Rejection::None, player->body};
    }

 private:
    /// Players' commands and the game's own are the rules' to refuse.
    Rejection judgeByRules(const Command& command) {
        const bool custom = std::holds_alternative<Custom>(command.action);
        if (m_world.rules == nullptr || (command.author == 0 && !custom)) return Rejection::None;
        if (!hasFiniteNumbers(command.action)) return Rejection::NotFinite;
        if (const auto* spawn = std::get_if<Spawn>(&command.action)) {
            if (const Rejection r = m_world.judge(*spawn, m_author); r != Rejection::None) return r;
        }
        Game game(m_world, *this);
        return m_world.rules->commandBytes(m_world.rulesState(), game, command);
    }

    Rejection apply(const Custom&) {
        return m_world.rules == nullptr ? Rejection::UnknownAction : Rejection::None;
    }

    [[nodiscard]] bool host() const { return m_author == 0; }
    PlayerRecord& author() { return *m_world.findPlayer(m_author); }

    /// A dynamic body to be pushed, or why not.
    Rejection findPushed(BodyId id, std::uint32_t& place) const {
        const auto found = m_world.findBody(id);
        if (!found) return Rejection::UnknownBody;
        place = *found;
        return m_state.bodies[place].dynamic() ? Rejection::None : Rejection::WrongBodyType;
    }

    /// Whether a player pushes at a point where the body is not: a long arm would make a weak push
    /// a strong one.
    [[nodiscard]] bool tooFar(std::uint32_t place, Vec2 point) const {
        const float arm = length(point - m_state.motions[place].position);
        return !host() && !(arm <= m_world.reachOf(place) + pushSlack);
    }

    [[nodiscard]] bool tooStrong(Vec2 v, float most) const {
        return !host() && !(length(v) <= most);
    }

    Rejection apply(const AddPlayer& action) {
        if (!host() || action.player == 0) return Rejection::NotAllowed;
        const WorldInfo& info = m_state.info();
        if ((info.flags & WorldInfo::players) == 0) return Rejection::NotAllowed;
        if (m_world.findPlayer(action.player)) return Rejection::PlayerExists;
        if (m_state.players.size() > info.maxPlayers) return Rejection::OverLimit;
        const bool body = !m_state.playerBody.empty();
        if (body && !roomFor(1, m_state.playerShapes.size(), 0)) return Rejection::OverLimit;
        PlayerRecord record{};
        record.id = action.player;
        record.joined = m_state.info().joinedPlayers++;
        if (body) record.body = m_firstBody = spawnPlayerBody(record);
        const auto at =
            std::lower_bound(m_state.players.begin(), m_state.players.end(), record.id,
                             [](const PlayerRecord& p, PlayerId id) { return p.id < id; });
        m_state.players.insert(at, record);
        return Rejection::None;
    }

    BodyId spawnPlayerBody(const PlayerRecord& player) {
        const std::vector<SpawnPoint>& points = m_state.spawnPoints;
        if (points.empty()) return addPlayerBody(player.id, std::nullopt);
        return addPlayerBody(player.id, points[player.joined % points.size()].position);
    }

    /// With its origin there, or where the scene says.
    BodyId addPlayerBody(PlayerId player, std::optional<Vec2> origin) {
        m_world.changeDefinitions();
        WorldInfo& info = m_state.info();
        BodyInfo body = m_state.playerBody.front();
        BodyMotion motion = m_state.playerMotion.front();
        body.id = info.nextBody++;
        body.owner = player;
        if (origin) {
            motion.position = *origin + rotate(motion.rotation, body.localCenter);
            motion.position = canonicalZero(motion.position);
        }
        m_state.bodies.push_back(body);
        m_state.motions.push_back(motion);
        for (ShapeInfo shape : m_state.playerShapes) {
            shape.id = info.nextShape++;
            shape.body = body.id;
            m_state.shapes.push_back(shape);
        }
        return body.id;
    }

    Rejection apply(const RemovePlayer& action) {
        if (!host() || action.player == 0) return Rejection::NotAllowed;
        const PlayerRecord* player = m_world.findPlayer(action.player);
        if (player == nullptr) return Rejection::UnknownAuthor;
        if (player->grab != 0) markJoint(player->grab);
        for (std::uint32_t i = 0; i < m_state.bodies.size(); ++i) {
            if (m_state.bodies[i].owner == action.player) markBody(i);
        }
        std::erase_if(m_state.players,
                      [&](const PlayerRecord& p) { return p.id == action.player; });
        return Rejection::None;
    }

    Rejection apply(const ApplyImpulse& action) {
        std::uint32_t place = 0;
        if (!isFinite(action.impulse) || !inWorld(action.point)) return Rejection::NotFinite;
        if (const Rejection r = findPushed(action.body, place); r != Rejection::None) return r;
        if (tooStrong(action.impulse, m_state.info().maxImpulse)) return Rejection::TooStrong;
        if (tooFar(place, action.point)) return Rejection::TooFar;
        const BodyInfo& info = m_state.bodies[place];
        BodyMotion& motion = m_state.motions[place];
        const Vec2 velocity = motion.velocity + info.inverseMass * action.impulse;
        const float spin =
            motion.angularVelocity +
            info.inverseInertia * cross(action.point - motion.position, action.impulse);
        if (!slow(velocity.x) || !slow(velocity.y) || !slow(spin)) return Rejection::TooStrong;
        motion.velocity = canonicalZero(velocity);
        motion.angularVelocity = canonicalZero(spin);
        m_world.wake(place);
        return Rejection::None;
    }

    Rejection apply(const ApplyForce& action) {
        std::uint32_t place = 0;
        if (!isFinite(action.force) || !inWorld(action.point)) return Rejection::NotFinite;
        if (const Rejection r = findPushed(action.body, place); r != Rejection::None) return r;
        if (tooStrong(action.force, m_state.info().maxForce)) return Rejection::TooStrong;
        if (tooFar(place, action.point)) return Rejection::TooFar;
        const float torque = cross(action.point - m_state.motions[place].position, action.force);
        const float dt = m_state.info().stepSeconds;
        const BodyInfo& info = m_state.bodies[place];
        if (!slow(dt * info.inverseMass * length(action.force)) ||
            !slow(dt * info.inverseInertia * torque)) {
            return Rejection::TooStrong;
        }
        m_world.forces.resize(m_state.bodies.size());
        BodyForce& sum = m_world.forces[place];
        sum.force += action.force;
        sum.torque += torque;
        m_world.wake(place);
        return Rejection::None;
    }

    Rejection apply(const Grab& action) {
        std::uint32_t place = 0;
        if (!inWorld(action.point) || !inWorld(action.target)) return Rejection::NotFinite;
        if (const Rejection r = findPushed(action.body, place); r != Rejection::None) return r;
        if (author().grab != 0) {
            const auto held = m_world.findJoint(author().grab);
            if (held && m_state.joints[*held].bodyB == action.body) {
                return apply(MoveGrab{action.target});
            }
        }
        if (tooFar(place, action.point)) return Rejection::TooFar;
        if (!roomFor(0, 0, 1)) return Rejection::OverLimit;
        if (author().grab != 0) markJoint(author().grab);
        m_world.changeDefinitions();
        const BodyMotion& motion = m_state.motions[place];
        const Vec2 anchor = unrotate(motion.rotation, action.point - motion.position);
        JointInfo j{};
        j.id = m_state.info().nextJoint++;
        j.flags = static_cast<std::uint32_t>(JointKind::Mouse) | JointInfo::spring;
        j.bodyB = action.body;
        j.owner = m_author;
        j.anchorB = canonicalZero(anchor);
        j.reference = {1.0f, 0.0f};
        j.target = canonicalZero(action.target);
        // What lifts the body and as much again, within the scene's cap.
        const float most = minOf(m_state.bodies[place].mass * 1000.0f, caps::maxEffort);
        j.maxForce = host() ? most : minOf(most, m_state.info().maxForce);
        j.springHertz = grabHertz;
        j.springDamping = grabDamping;
        m_state.joints.push_back(j);
        m_state.jointImpulses.push_back({});
        author().grab = j.id;
        m_world.wake(place);
        return Rejection::None;
    }

    Rejection apply(const MoveGrab& action) {
        if (!inWorld(action.target)) return Rejection::NotFinite;
        const auto held = m_world.findJoint(author().grab);
        if (author().grab == 0 || !held) return Rejection::NothingGrabbed;
        JointInfo& joint = m_state.joints[*held];
        joint.target = canonicalZero(action.target);
        m_world.touchDefinitions();
        if (const auto body = m_world.findBody(joint.bodyB)) m_world.wake(*body);
        return Rejection::None;
    }

    Rejection apply(const Release&) {
        if (author().grab == 0) return Rejection::NothingGrabbed;
        markJoint(author().grab);
        author().grab = 0;
        return Rejection::None;
    }

    [[nodiscard]] bool roomFor(std::size_t bodies, std::size_t shapes, std::size_t joints) const {
        const WorldInfo& info = m_state.info();
        constexpr std::uint32_t lastId = 0xfffffff0u;  // ids never wrap
        return m_state.bodies.size() + bodies <= info.maxBodies &&
               m_state.shapes.size() + shapes <= info.maxShapes &&
               m_state.joints.size() + joints <= info.maxJoints &&
               info.nextBody + bodies < lastId && info.nextShape + shapes < lastId &&
               info.nextJoint + joints < lastId;
    }

    Rejection apply(const Spawn& action) {
        if (const Rejection r = m_world.judge(action, m_author); r != Rejection::None) return r;
        std::size_t shapes = 0;
        for (const BodyDef& body : action.bodies) shapes += body.shapes.size();
        if (!roomFor(action.bodies.size(), shapes, action.joints.size())) {
            return Rejection::OverLimit;
        }
        m_firstBody = m_world.add(action.bodies, action.joints, m_author);
        return Rejection::None;
    }

    Rejection apply(const RemoveBody& action) {
        const auto place = m_world.findBody(action.body);
        if (!place) return Rejection::UnknownBody;
        const BodyInfo& body = m_state.bodies[*place];
        if (!host() && (body.owner != m_author || body.id == author().body)) {
            return Rejection::NotAllowed;
        }
        markBody(*place);
        return Rejection::None;
    }

    Rejection apply(const RemoveJoint& action) {
        if (!host()) return Rejection::NotAllowed;
        if (!m_world.findJoint(action.joint)) return Rejection::UnknownJoint;
        markJoint(action.joint);
        return Rejection::None;
    }

    Rejection apply(const SetMotor& action) {
        if (!isFinite(action.speed) || !(action.speed >= -maxSpeed && action.speed <= maxSpeed)) {
            return Rejection::NotFinite;
        }
        const auto place = m_world.findJoint(action.joint);
        if (!place) return Rejection::UnknownJoint;
        JointInfo& joint = m_state.joints[*place];
        if (!joint.has(JointInfo::hasMotor)) return Rejection::NoMotor;
        joint.motorSpeed = canonicalZero(action.speed);
        joint.flags =
            action.enabled ? joint.flags | JointInfo::motor : joint.flags & ~JointInfo::motor;
        if (!action.enabled) m_state.jointImpulses[*place].motor = 0.0f;
        m_world.touchDefinitions();
        for (const BodyId id : {joint.bodyA, joint.bodyB}) {
            if (const auto body = m_world.findBody(id)) m_world.wake(*body);
        }
        return Rejection::None;
    }

    Rejection apply(const SetVelocity& action) {
        if (!host()) return Rejection::NotAllowed;
        const auto in = [](float v) { return v >= -maxSpeed && v <= maxSpeed; };
        if (!in(action.velocity.x) || !in(action.velocity.y) || !in(action.angularVelocity)) {
            return Rejection::NotFinite;
        }
        const auto place = m_world.findBody(action.body);
        if (!place) return Rejection::UnknownBody;
        if (m_state.bodies[*place].type() != BodyType::Kinematic) return Rejection::WrongBodyType;
        BodyMotion& motion = m_state.motions[*place];
        motion.velocity = canonicalZero(action.velocity);
        motion.angularVelocity = canonicalZero(action.angularVelocity);
        return Rejection::None;
    }

    Rejection apply(const SetTarget& action) {
        if (!host()) return Rejection::NotAllowed;
        const RotationT<double> target = inDouble(action.rotation);
        const double square = target.c * target.c + target.s * target.s;
        const double off = square - 1.0;
        const auto tolerance = static_cast<double>(caps::rotationTolerance);
        if (!inWorld(action.position) || !(off >= -tolerance && off <= tolerance)) {
            return Rejection::NotFinite;
        }
        const auto place = m_world.findBody(action.body);
        if (!place) return Rejection::UnknownBody;
        if (m_state.bodies[*place].type() != BodyType::Kinematic) return Rejection::WrongBodyType;
        // In double, as the step rounds once itself: the body ends within a rounding or two.
        BodyMotion& motion = m_state.motions[*place];
        const double perSecond = 1.0 / static_cast<double>(m_state.info().stepSeconds);
        const Vec2T<double> way = inDouble(action.position) - inDouble(motion.position);
        const double turn = angleOf(relative(inDouble(motion.rotation), target));
        const Vec2 velocity{static_cast<float>(perSecond * way.x),
                            static_cast<float>(perSecond * way.y)};
        const auto spin = static_cast<float>(perSecond * turn);
        if (!slow(velocity.x) || !slow(velocity.y) || !slow(spin)) return Rejection::TooFar;
        motion.velocity = canonicalZero(velocity);
        motion.angularVelocity = canonicalZero(spin);
        return Rejection::None;
    }

    void markBody(std::uint32_t place) {
        m_world.removed.resize(m_state.bodies.size(), 0);
        m_world.removed[place] = 1;
    }
    void markJoint(JointId id) {
        if (const auto place = m_world.findJoint(id)) {
            m_world.removedJoints.resize(m_state.joints.size(), 0);
            m_world.removedJoints[*place] = 1;
        }
    }

    World::Data& m_world;
    WorldState& m_state;
    PlayerId m_author = 0;
    BodyId m_firstBody = 0;
    std::uint32_t m_fromPlayers = 0;
};

void World::Data::applyCommands(std::span<const Command> commands) {
    // Frames come sorted; whoever calls with another order gets the order of the key all the same.
    std::vector<Command> sorted(commands.begin(), commands.end());
    sortByKey(sorted);
    Applier applier(*this);
    for (const Command& command : sorted) events.commands.push_back(applier.apply(command));
    if (rules != nullptr) {
        Game game(*this, applier);
        rules->beforeBytes(rulesState(), game);
    }
    // A body that came after a force of the same tick has none.
    if (!forces.empty()) forces.resize(state.bodies.size());
    removeMarked();
}

Game::Game(World::Data& world, Applier& applier) : Seen(world), m_data(world), m_applier(applier) {}

RulesOutcome Game::act(const RulesAction& action, PlayerId as) {
    return m_applier.act(action, as);
}

RulesOutcome Game::respawn(PlayerId player, Vec2 position) {
    return m_applier.respawn(player, position);
}

}  // namespace huestep
