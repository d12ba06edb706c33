#include "client/bot.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "client/centre.h"
#include "client/dice.h"

namespace huestep::client {

namespace {

class IdleBot : public Bot {
 public:
    std::vector<Action> act(const Situation&) override { return {}; }
};

/// Bodies the player spawned, its own body aside, oldest first.
std::vector<BodyId> spawnedBy(const Situation& now) {
    std::vector<BodyId> out;
    for (const BodyInfo& body : now.world.bodies()) {
        if (body.owner == now.player && body.id != now.body) out.push_back(body.id);
    }
    return out;
}

Spawn spawnOf(ShapeDef shape, Vec2 at) {
    BodyDef body;
    body.type = BodyType::Dynamic;
    body.position = at;
    body.shapes.push_back(shape);
    return Spawn{{body}, {}};
}

class WanderBot : public Bot {
 public:
    explicit WanderBot(std::uint64_t seed) : m_dice(seed) {}

    std::vector<Action> act(const Situation& now) override {
        std::vector<Action> out;
        const std::optional<Vec2> here = centreOf(now.world, now.body);
        if (!here) return out;
        push(now, *here, out);
        if (m_dice.once(90)) grabOrRelease(now, *here, out);
        if (m_dice.once(120)) spawnOrRemove(now, *here, out);
        return out;
    }

 private:
    void push(const Situation& now, Vec2 here, std::vector<Action>& out) {
        if (m_pushes == 0) {
            if (!m_dice.once(20)) return;
            m_pushes = 6 + static_cast<int>(m_dice.roll() % 12);
            // Home is the origin: the further away, the more it is drawn back.
            m_heading = {m_dice.between(-1.0f, 1.0f) - 0.02f * here.x, m_dice.between(-0.3f, 1.0f)};
        }
        --m_pushes;
        const std::uint32_t place = *now.world.find(now.body);
        const float mass = now.world.bodies()[place].mass;
        out.push_back(ApplyImpulse{now.body, (0.6f * mass) * m_heading, here});
    }

    void grabOrRelease(const Situation& now, Vec2 here, std::vector<Action>& out) {
        // What the world says it holds: a grab ends with its body, whoever removed that.
        if (holds(now)) {
            out.push_back(Release{});
            return;
        }
        const std::vector<BodyId> near = grabbable(now, here);
        if (near.empty()) return;
        const BodyId body = near[m_dice.roll() % near.size()];
        const Vec2 point = *centreOf(now.world, body);
        const Vec2 pull{m_dice.between(-2.0f, 2.0f), m_dice.between(0.5f, 3.0f)};
        out.push_back(Grab{body, point, point + pull});
    }

    static bool holds(const Situation& now) {
        for (const PlayerRecord& player : now.world.players()) {
            if (player.id == now.player) return player.grab != 0;
        }
        return false;
    }

    static std::vector<BodyId> grabbable(const Situation& now, Vec2 here) {
        constexpr float reach = 5.0f;  // m
        std::vector<BodyId> out;
        const auto bodies = now.world.bodies();
        for (std::size_t i = 0; i < bodies.size(); ++i) {
            if (!bodies[i].dynamic() || bodies[i].id == now.body) continue;
            if (lengthSquared(now.world.motions()[i].position - here) < reach * reach) {
                out.push_back(bodies[i].id);
            }
        }
        return out;
    }

    void spawnOrRemove(const Situation& now, Vec2 here, std::vector<Action>& out) {
        const std::vector<BodyId> mine = spawnedBy(now);
        const std::size_t most = std::min<std::size_t>(4, now.world.info().maxSpawned);
        if (mine.size() < most && !m_dice.once(3)) {
            const Vec2 at{here.x + m_dice.between(-1.5f, 1.5f), here.y + 2.0f};
            const float size = m_dice.between(0.15f, 0.35f);
            out.push_back(m_dice.once(2) ? spawnOf(ShapeDef::circle({}, size), at)
                                         : spawnOf(ShapeDef::box(size, size), at));
        } else if (!mine.empty()) {
            out.push_back(RemoveBody{mine.front()});
        }
    }

    Dice m_dice;
    int m_pushes = 0;
    Vec2 m_heading;
};

class ScriptBot : public Bot {
 public:
    explicit ScriptBot(std::vector<ScriptLine> lines) : m_lines(std::move(lines)) {}

    std::vector<Action> act(const Situation& now) override {
        std::vector<Action> out;
        for (; m_next < m_lines.size() && m_lines[m_next].tick <= now.played; ++m_next) {
            out.push_back(resolved(m_lines[m_next], now));
        }
        return out;
    }

 private:
    static Action resolved(const ScriptLine& line, const Situation& now) {
        Action action = line.action;
        BodyId body = 0;
        if (line.onSelf) body = now.body;
        if (line.onLastSpawn) {
            const std::vector<BodyId> mine = spawnedBy(now);
            body = mine.empty() ? 0 : mine.back();
        }
        const bool named = line.onSelf || line.onLastSpawn;
        std::visit(
            [&](auto& content) {
                if constexpr (requires { content.body; }) {
                    if (named) content.body = body;
                    if constexpr (requires { content.point; }) {
                        if (line.atCenter) {
                            content.point = centreOf(now.world, content.body).value_or(Vec2{});
                        }
                    }
                }
            },
            action);
        return action;
    }

    std::vector<ScriptLine> m_lines;
    std::size_t m_next = 0;
};

}  // namespace

std::unique_ptr<Bot> makeIdleBot() {
    return std::make_unique<IdleBot>();
}

std::unique_ptr<Bot> makeWanderBot(std::uint64_t seed) {
    return std::make_unique<WanderBot>(seed);
}

std::unique_ptr<Bot> makeScriptBot(std::vector<ScriptLine> lines) {
    return std::make_unique<ScriptBot>(std::move(lines));
}

}  // namespace huestep::client
