/// A server process in virtual time: a hub, a disk that takes its time, and a clock.
#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "link.h"
#include "protocol/memory_store.h"
#include "server/hub.h"
#include "server/log_writer.h"
#include "server/recovery.h"
#include "server/tick_clock.h"

namespace huestep::test {

/// The journal's writer: what it is given is on disk `delay` later, or never.
class SimulatedJournal : public server::JournalSink {
 public:
    SimulatedJournal(protocol::JournalWriter writer, Dice& dice)
        : m_writer(std::move(writer)), m_dice(dice) {}

    void write(const std::string&, server::ClosedTick closed) override {
        m_waiting.push_back(std::move(closed));
    }

    /// Commits what waits, if the disk is ready. A sentence: the journal failed.
    Status run(Instant now, server::Hub& hub, const std::string& session) {
        if (now < m_readyAt || m_waiting.empty()) return Done{};
        const std::vector<server::ClosedTick> batch(std::make_move_iterator(m_waiting.begin()),
                                                    std::make_move_iterator(m_waiting.end()));
        m_waiting.clear();
        std::string warning;
        if (Status written = server::commitBatch(m_writer, batch, warning); !written) {
            hub.failed(session, written.error().message, now);
            return written;
        }
        if (!warning.empty()) warnings.push_back(warning);
        hub.committed(session, batch.back().commits);
        m_readyAt = now + m_dice.between(0, m_dice.once(10) ? 400 : 30) * ms;
        return Done{};
    }

    std::vector<std::string> warnings;

 private:
    protocol::JournalWriter m_writer;
    Dice& m_dice;
    std::vector<server::ClosedTick> m_waiting;
    Instant m_readyAt = 0;
};

struct ServerSetup {
    std::string session = "play";
    protocol::Fingerprint fingerprint{1, 2, 3};
    const Scene* scene = nullptr;
    server::Limits limits;
    server::LogSink log;
};

class ServerProcess {
 public:
    /// Starts, or starts again, from what the disk holds.
    static Result<std::unique_ptr<ServerProcess>> start(const ServerSetup& setup,
                                                        protocol::LogStore& disk, Instant now,
                                                        Dice& dice) {
        server::RecoveryRequest request{setup.session, setup.fingerprint, setup.scene, {}, {}};
        for (std::uint8_t& byte : request.freshKey) byte = static_cast<std::uint8_t>(dice.roll());
        Result<server::RecoveredSession> recovered = server::recoverSession(disk, request);
        if (!recovered) return recovered.error();
        Result<protocol::JournalWriter> writer = protocol::JournalWriter::open(
            disk, recovered->identity, recovered->contents, recovered->start.world.tick());
        if (!writer) return writer.error();
        auto process =
            std::unique_ptr<ServerProcess>(new ServerProcess(setup, std::move(*writer), dice));
        Result<server::Session*> added = process->m_hub.add(std::move(recovered->start), now);
        if (!added) return added.error();
        process->m_session = *added;
        process->m_clock.emplace(now, (*added)->ticksPerSecond(), 0.0, setup.limits.catchUpTicks);
        return process;
    }

    server::Hub& hub() { return m_hub; }
    server::Session& session() { return *m_session; }
    const SimulatedJournal& journal() const { return m_journal; }

    /// Lets time pass. A sentence: the journal failed, the process is as good as dead.
    Status run(Instant now) {
        for (std::uint32_t due = m_clock->due(now); due > 0; --due) {
            m_hub.closeTick(*m_session, now);
            for (int i = 0; i < 4; ++i) m_hub.work(*m_session);
        }
        if (now >= m_advancedAt + 50 * ms) {
            m_advancedAt = now;
            m_hub.advance(now);
        }
        return m_journal.run(now, m_hub, m_setup.session);
    }

 private:
    ServerProcess(const ServerSetup& setup, protocol::JournalWriter writer, Dice& dice)
        : m_setup(setup),
          m_journal(std::move(writer), dice),
          m_hub({setup.limits, setup.fingerprint, setup.log, {}}, m_journal) {}

    ServerSetup m_setup;
    SimulatedJournal m_journal;
    server::Hub m_hub;
    server::Session* m_session = nullptr;
    std::optional<server::TickClock> m_clock;
    Instant m_advancedAt = 0;
};

}  // namespace huestep::test
