#include "server/session.h"

#include <algorithm>
#include <cassert>
#include <iterator>
#include <utility>

namespace huestep::server {

namespace {

const PlayerRecord* playerIn(const World& world, PlayerId id) {
    for (const PlayerRecord& player : world.players()) {
        if (player.id == id) return &player;
    }
    return nullptr;
}

std::uint64_t sequenceIn(const World& world, PlayerId id) {
    const PlayerRecord* player = playerIn(world, id);
    return player ? player->lastSequence : 0;
}

}  // namespace

Session::Session(SessionStart start, const Limits& limits, Instant now)
    : m_name(std::move(start.name)),
      m_epoch(start.epoch),
      m_limits(limits),
      m_world(std::move(start.world)),
      m_script(std::move(start.script)),
      m_seats(m_name, start.epoch, start.key, limits),
      m_queue(limits),
      m_frames(limits.recentFrames, limits.recentBytes),
      m_keyframes(limits.keyframes),
      m_rebuilder(m_frames, m_keyframes, limits),
      m_committed(m_world.tick()),
      m_closedAt(now) {
    for (protocol::Frame& frame : start.tail) m_frames.push(std::move(frame));
    if (start.base) m_keyframes.push(std::move(start.base));
    m_keyframes.push(takeSnapshot(m_world));
    m_seats.recover(m_world, now);
    m_seats.committed(m_committed);
    noteDefinitions();
}

double Session::ticksPerSecond() const {
    return 1.0 / static_cast<double>(m_world.info().stepSeconds);
}

bool Session::hasPlayers() const {
    return (m_world.info().flags & WorldInfo::players) != 0;
}

bool Session::mayClose() const {
    return !m_failure && tick() < m_committed + m_limits.uncommittedTicks;
}

ClosedTick Session::closeTick(Instant now, const StepResources& with) {
    assert(mayClose());
    protocol::Frame frame;
    frame.tick = tick();
    m_closedAt = now;
    gather(frame, now);
    frame.previousRoot = m_world.motionRoot();
    frame.committed = m_committed;

    m_world.step(frame.commands, with);
    m_seats.applied(m_world, frame.tick);
    noteDefinitions();

    ClosedTick out;
    out.commits = tick();
    out.entries.push_back({m_epoch, frame});
    m_frames.push(std::move(frame));
    if (tick() % m_limits.keyframeTicks == 0) m_keyframes.push(takeSnapshot(m_world));
    if (tick() % m_limits.journalSnapshotTicks == 0) {
        const ClosedTick record = finalRecord();
        out.entries.insert(out.entries.end(), record.entries.begin(), record.entries.end());
        out.snapshot = record.snapshot;
    }
    out.newSegment = tick() % m_limits.segmentTicks == 0;
    return out;
}

/// The commands of the frame, and whose came too late.
void Session::gather(protocol::Frame& frame, Instant now) {
    std::vector<Command>& commands = frame.commands;
    commands = m_seats.commandsFor(m_world, sequenceIn(m_world, 0), now);
    for (const Command& command : commands) {
        if (const auto* removed = std::get_if<RemovePlayer>(&command.action)) {
            m_queue.forget(removed->player);
        }
    }
    // The script's ids count on nobody else's bodies, its sequences follow on what the host said.
    std::uint64_t sequence = sequenceIn(m_world, 0) + commands.size();
    for (Action& action : m_script.actions(tick())) {
        commands.push_back({0, ++sequence, std::move(action)});
    }
    // The world's own cap is of players' commands alone, as this one is.
    const std::uint32_t room =
        std::min(m_limits.commandsPerFrame, m_world.info().maxCommandsPerTick);
    CommandQueue::Due due = m_queue.take(tick(), room);
    commands.insert(commands.end(), std::make_move_iterator(due.commands.begin()),
                    std::make_move_iterator(due.commands.end()));
    sortByKey(commands);
    const std::vector<PlayerId> silent = m_seats.late(tick());
    std::set_union(silent.begin(), silent.end(), due.late.begin(), due.late.end(),
                   std::back_inserter(frame.substituted));
}

void Session::committed(std::uint64_t below) {
    m_committed = std::max(m_committed, std::min(below, tick()));
    m_seats.committed(m_committed);
}

void Session::fail(std::string sentence) {
    if (!m_failure) m_failure = std::move(sentence);
}

ClosedTick Session::finalRecord() const {
    ClosedTick out;
    const SharedSnapshot newest = m_keyframes.newest();
    out.snapshot = newest && newest->tick == tick() ? newest : takeSnapshot(m_world);
    out.entries.push_back({m_epoch, protocol::FullRoot{tick(), m_world.fullRoot()}});
    out.commits = tick();
    return out;
}

CommandQueue::Admission Session::queue(PlayerId player, Command command, std::uint64_t asked) {
    command.author = player;
    const std::uint64_t earliest = asked == 0
                                       ? tick() + m_limits.inputDelay
                                       : std::clamp(asked, tick(), tick() + m_limits.askedAhead);
    const bool late = asked != 0 && asked < tick();
    return m_queue.push(std::move(command), earliest, sequenceIn(m_world, player), late);
}

std::uint64_t Session::lastSequence(PlayerId player) const {
    return std::max(sequenceIn(m_world, player), m_queue.lastQueued(player));
}

std::optional<std::uint64_t> Session::rootAt(std::uint64_t at) const {
    if (at == tick()) return m_world.motionRoot();
    if (const protocol::Frame* frame = m_frames.find(at)) return frame->previousRoot;
    return std::nullopt;
}

SharedSnapshot Session::snapshotForJoin(std::uint64_t notBefore) {
    const std::uint64_t recent = tick() > m_limits.freshTicks ? tick() - m_limits.freshTicks : 0;
    const std::uint64_t earliest = std::min(notBefore, tick());
    const auto goesOn = [this](const Snapshot& from) {
        return from.tick == tick() || m_frames.find(from.tick);
    };
    for (const SharedSnapshot& candidate : {m_fresh, m_keyframes.newest()}) {
        if (!candidate || candidate->tick < std::max(recent, earliest)) continue;
        if (!goesOn(*candidate)) continue;
        if (SharedSnapshot lent = lend(candidate)) return lent;
    }
    if (lentNow().size() < m_limits.lentSnapshots) {
        m_fresh = takeSnapshot(m_world);
        return lend(m_fresh);
    }
    SharedSnapshot newest;
    for (const SharedSnapshot& lent : lentNow()) {
        if (lent->tick < earliest || !goesOn(*lent)) continue;
        if (!newest || lent->tick > newest->tick) newest = lent;
    }
    return newest;
}

SharedSnapshot Session::snapshotOf(const World& world) {
    return lentNow().size() < m_limits.lentSnapshots ? lend(takeSnapshot(world)) : nullptr;
}

SharedSnapshot Session::lend(const SharedSnapshot& snapshot) {
    const std::vector<SharedSnapshot> now = lentNow();
    for (const SharedSnapshot& lent : now) {
        if (lent.get() == snapshot.get()) return lent;
    }
    if (now.size() >= m_limits.lentSnapshots) return nullptr;
    // A pointer with a count of its own: what is kept here besides does not count as lent.
    SharedSnapshot lent(snapshot.get(), [snapshot](const Snapshot*) {});
    m_lent.push_back(lent);
    return lent;
}

std::vector<SharedSnapshot> Session::lentNow() {
    std::vector<SharedSnapshot> now;
    for (const auto& each : m_lent) {
        if (SharedSnapshot lent = each.lock()) now.push_back(std::move(lent));
    }
    m_lent.assign(now.begin(), now.end());
    return now;
}

void Session::noteDefinitions() {
    if (m_definitionMark.note(m_world)) ++m_definitions;
}

}  // namespace huestep::server
