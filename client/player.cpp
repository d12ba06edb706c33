#include "client/player.h"

#include <uv.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <optional>
#include <utility>

#include "client/connection.h"
#include "protocol/address.h"

namespace huestep::client {

namespace {

constexpr std::uint64_t houseMs = 50;
constexpr std::uint64_t progressMs = 1'000;
constexpr std::uint64_t longestWaitMs = 20;  // of a client that predicts or lags

Destination destinationOf(const PlayerConfig& config, protocol::Address address) {
    Destination out;
    out.address = std::move(address);
    out.silenceMs = static_cast<std::uint64_t>(config.silenceSeconds * 1e3);
    out.resolve = config.resolve;
    out.tls = config.tls;
    return out;
}

/// Whether the message brings a client that has no state nearer to it.
bool isOfState(const protocol::Message& message) {
    return std::holds_alternative<protocol::SnapshotBegin>(message) ||
           std::holds_alternative<protocol::SnapshotChunk>(message);
}

bool isFinal(const protocol::Bye& bye) {
    // A refused token costs the seat, not the game: the next attempt joins anew.
    return !bye.mayResume && bye.reason != protocol::ByeReason::ResumeRefused;
}

std::string wholeSeconds(double seconds) {
    return std::to_string(std::lround(std::ceil(seconds))) + " s";
}

/// One client's life on a loop of its own.
class Life {
 public:
    Life(PlayerConfig config, protocol::Address address)
        : m_config(std::move(config)),
          m_executor(m_config.threads > 1
                         ? std::make_unique<Executor>(m_config.threads, 0, nullptr, uv_hrtime)
                         : nullptr),
          m_replica(ReplicaConfig{m_config.session,
                                  m_config.role,
                                  m_config.fingerprint,
                                  {m_executor.get()},
                                  30,
                                  m_config.prediction,
                                  m_config.ticket}),
          m_in(m_config.lag),
          m_out(LagRules{m_config.lag.delay, m_config.lag.jitter, m_config.lag.seed + 1}) {
        if (!m_config.bot) m_config.bot = makeIdleBot();
        const int opened = uv_loop_init(&m_loop);
        if (opened != 0) {
            m_failure = std::string("a client cannot start: ") + uv_strerror(opened);
            return;
        }
        m_connection = std::make_unique<Connection>(
            m_loop, destinationOf(m_config, std::move(address)),
            Connection::Events{[this] { connected(); },
                               [this](protocol::Message m) { arrived(std::move(m)); },
                               [this] { idle(); }, [this](const std::string& why) { lost(why); },
                               [this](const std::string& why) {
                                   fail("no connection to " + m_config.address + ": " + why);
                               }});
        uv_timer_init(&m_loop, &m_house);
        uv_timer_init(&m_loop, &m_beat);
        uv_signal_init(&m_loop, &m_interrupt);
        uv_signal_init(&m_loop, &m_terminate);
        m_house.data = m_beat.data = m_interrupt.data = m_terminate.data = this;
    }
    ~Life() {
        if (m_connection) uv_loop_close(&m_loop);
    }
    Life(const Life&) = delete;
    Life& operator=(const Life&) = delete;

    Result<Statistics> run() {
        if (m_failure) return Error{*m_failure};
        m_apartSince = m_progressAt = uv_hrtime();
        uv_timer_start(
            &m_house, [](uv_timer_t* timer) { static_cast<Life*>(timer->data)->house(); }, houseMs,
            houseMs);
        if (m_config.lag.any() || m_replica.prediction()) scheduleBeat(1);
        if (m_config.handleSignals) {
            const auto onSignal = [](uv_signal_t* handle, int) {
                static_cast<Life*>(handle->data)->leave();
            };
            int status = uv_signal_start(&m_interrupt, onSignal, SIGINT);
            if (status == 0) status = uv_signal_start(&m_terminate, onSignal, SIGTERM);
            if (status != 0) fail(std::string("signals cannot be caught: ") + uv_strerror(status));
        }
        if (!m_ended) m_connection->start();
        uv_run(&m_loop, UV_RUN_DEFAULT);
        if (m_config.onEnd && m_replica.counts().connections != 0) m_config.onEnd(statistics());
        if (m_failure) return Error{*m_failure};
        return statistics();
    }

 private:
    void connected() {
        m_stateAt = 0;
        m_replica.connected(uv_hrtime());
        flush();
    }

    void message(protocol::Message message) {
        const std::uint64_t mismatches = m_replica.counts().mismatches;
        const bool ofState = isOfState(message);
        const bool welcome = std::holds_alternative<protocol::Welcome>(message);
        const Status taken = m_replica.receive(std::move(message), uv_hrtime());
        flush();
        if (m_replica.counts().mismatches != mismatches) {
            notice("this world differs from the server's; asking for its state");
        }
        noteState(ofState, welcome);
        if (!taken) return m_connection->drop(taken.error().message);
        if (!m_replica.bye()) return;
        const protocol::Bye bye = *m_replica.bye();
        if (isFinal(bye)) return fail("the server refuses: " + bye.text);
        m_connection->drop("the server says: " + bye.text);
    }

    void arrived(protocol::Message m) {
        if (!m_config.lag.any()) return message(std::move(m));
        m_in.put(std::move(m), uv_hrtime());
    }

    /// What is to happen at its time, whatever arrives: held messages, and the predicted world.
    void beat() {
        const Instant now = uv_hrtime();
        bool any = false;
        while (std::optional<protocol::Message> held = m_in.take(now)) {
            any = true;
            message(std::move(*held));
            if (m_ended) return;
        }
        m_replica.advance(now);
        if (any || m_replica.prediction()) idle();
        flush();
        if (!m_ended) scheduleBeat(m_config.lag.any() ? 1 : msToNextTick(now));
    }

    [[nodiscard]] std::uint64_t msToNextTick(Instant now) const {
        if (!m_replica.following()) return longestWaitMs;
        const Pacer& pacer = m_replica.prediction()->pacer();
        const Instant due = pacer.timeOf(m_replica.timeline()->head() + 1);
        const std::uint64_t wait = due > now ? (due - now + 999'999) / 1'000'000 : 0;
        return std::clamp<std::uint64_t>(wait, 1, longestWaitMs);
    }

    void scheduleBeat(std::uint64_t milliseconds) {
        uv_timer_start(
            &m_beat, [](uv_timer_t* timer) { static_cast<Life*>(timer->data)->beat(); },
            milliseconds, 0);
    }

    /// Everything that arrived is applied: the bot sees the newest world, once.
    void idle() {
        const World* world = m_replica.world();
        if (m_ended || !world || !m_replica.following()) return;
        const std::uint64_t played = m_replica.counts().ticks;
        if (m_config.ticks != 0 && played >= m_config.ticks) return leave();
        // A predicted world goes on between frames, and is at a tick but once.
        const std::uint64_t ticks = played + m_replica.timeline()->ahead();
        if (ticks <= m_botTicks) return;
        m_botTicks = ticks;
        for (Action& action : m_config.bot->act({*world, m_replica.player(), ownBody(), ticks})) {
            const Status asked = m_replica.act(std::move(action), uv_hrtime());
            if (!asked &&
                asked.error().message != std::exchange(m_lastRefusal, asked.error().message)) {
                notice("the bot's action is not taken: " + asked.error().message);
            }
        }
        flush();
    }

    /// Waiting for the session's state, too, ends: it is given up when no piece of it came for too
    /// long. A large one over a slow line may take its time.
    void noteState(bool ofState, bool welcome) {
        const Instant now = uv_hrtime();
        const bool following = m_replica.following();
        if (following) {
            if (!std::exchange(m_toldPlay, true)) {
                const std::string seat =
                    m_replica.player() == 0 ? "" : ", player " + std::to_string(m_replica.player());
                notice("connected to " + m_config.address + ", session '" + m_config.session + "'" +
                       seat);
            } else if (m_toldLoss) {
                notice("connected again");
            }
            m_apartSince = 0;
            m_toldLoss = false;
        } else if (ofState || m_apartSince == 0) {
            m_apartSince = m_stateAt = now;
        } else if (welcome) {
            m_stateAt = now;
        }
    }

    [[nodiscard]] BodyId ownBody() const {
        for (const PlayerRecord& player : m_replica.world()->players()) {
            if (player.id == m_replica.player()) return player.body;
        }
        return 0;
    }

    void lost(const std::string& why) {
        m_stateAt = 0;
        m_in.clear();
        m_out.clear();
        m_replica.disconnected();
        if (m_apartSince == 0) m_apartSince = uv_hrtime();
        if (!std::exchange(m_toldLoss, true)) {
            const bool never = m_replica.counts().connections == 0;
            notice((never ? "no connection to " + m_config.address : "connection lost") + ": " +
                   why + "; trying again for " + wholeSeconds(limitSeconds()));
        }
        m_lastWhy = why;
    }

    void house() {
        const Instant now = uv_hrtime();
        if (m_config.stop && m_config.stop->load()) leave();
        if (m_ended) return;
        const bool waits = m_stateAt != 0 && !m_replica.following();
        if (waits && static_cast<double>(now - m_stateAt) > m_config.silenceSeconds * 1e9) {
            m_connection->drop("the server does not send the session's state");
        }
        const double limit = limitSeconds();
        if (m_apartSince != 0 && static_cast<double>(now - m_apartSince) > limit * 1e9) {
            fail("no connection to " + m_config.address + ": " + reason());
        }
        if (m_config.onProgress && now > m_progressAt + progressMs * 1'000'000) {
            m_progressAt = now;
            m_config.onProgress(statistics());
        }
    }

    /// How long to be apart before it is given up.
    [[nodiscard]] double limitSeconds() const {
        return m_replica.counts().connections == 0 ? m_config.connectSeconds
                                                   : m_config.reconnectSeconds;
    }

    /// Why there is no connection, as far as it is known.
    [[nodiscard]] std::string reason() const { return m_lastWhy.empty() ? "no answer" : m_lastWhy; }

    void leave() {
        if (m_ended) return;
        if (m_replica.counts().connections == 0)
            return fail("stopped before it was in session '" + m_config.session + "' at " +
                        m_config.address + ": " + reason());
        m_replica.leave();
        flush();
        while (std::optional<protocol::Message> held = m_out.take(~Instant{0})) {
            m_connection->send(*held);  // its Bye, which has no time to wait
        }
        end();
    }

    void fail(std::string sentence) {
        if (m_ended) return;
        m_failure = std::move(sentence);
        end();
    }

    void end() {
        m_ended = true;
        m_connection->stop();
        uv_close(reinterpret_cast<uv_handle_t*>(&m_house), nullptr);
        uv_close(reinterpret_cast<uv_handle_t*>(&m_beat), nullptr);
        uv_close(reinterpret_cast<uv_handle_t*>(&m_interrupt), nullptr);
        uv_close(reinterpret_cast<uv_handle_t*>(&m_terminate), nullptr);
    }

    void flush() {
        const Instant now = uv_hrtime();
        for (protocol::Message& message : m_replica.takeOutgoing()) {
            if (m_config.lag.any()) {
                m_out.put(std::move(message), now);
            } else {
                m_connection->send(message);
            }
        }
        while (std::optional<protocol::Message> held = m_out.take(now)) m_connection->send(*held);
    }

    void notice(const std::string& sentence) {
        if (m_config.onNotice) m_config.onNotice(sentence);
    }

    [[nodiscard]] Statistics statistics() const {
        Statistics out = m_replica.statistics();
        out.bytesIn = m_connection->bytesIn();
        out.bytesOut = m_connection->bytesOut();
        return out;
    }

    PlayerConfig m_config;
    std::unique_ptr<Executor> m_executor;
    Replica m_replica;
    Lag m_in;
    Lag m_out;
    uv_loop_t m_loop{};
    std::unique_ptr<Connection> m_connection;
    uv_timer_t m_house{};
    uv_timer_t m_beat{};  ///< of a client that predicts or lags
    uv_signal_t m_interrupt{};
    uv_signal_t m_terminate{};
    Instant m_apartSince = 0;  ///< 0: playing
    Instant m_stateAt = 0;     ///< of Welcome or, later, of the last piece of the state
    bool m_toldLoss = false;   ///< since it last played
    bool m_toldPlay = false;
    Instant m_progressAt = 0;
    std::uint64_t m_botTicks = 0;
    std::string m_lastWhy;
    std::string m_lastRefusal;
    std::optional<std::string> m_failure;
    bool m_ended = false;
};

}  // namespace

Result<Statistics> play(PlayerConfig config) {
    Result<protocol::Address> address = protocol::parseAddress(config.address, false);
    if (!address) return address.error();
    return Life(std::move(config), std::move(*address)).run();
}

}  // namespace huestep::client
