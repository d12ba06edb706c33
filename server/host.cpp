#include "server/host.h"

#include <uv.h>

#include <algorithm>
#include <csignal>
#include <optional>
#include <stdexcept>
#include <utility>

#include "core/scene/catalog.h"
#include "protocol/journal.h"
#include "server/log_writer.h"
#include "server/recovery.h"
#include "server/sockets.h"
#include "server/tick_clock.h"

namespace huestep::server {

namespace {

constexpr std::uint64_t housekeepingMs = 100;

Result<ResumeKey> randomKey() {
    ResumeKey key{};
    const int status = uv_random(nullptr, nullptr, key.data(), key.size(), 0, nullptr);
    if (status != 0) return Error{std::string("no random bytes: ") + uv_strerror(status)};
    return key;
}

/// Without random bytes no session is opened either, so zeros do no harm.
ResumeKey visitorsKey() {
    const Result<ResumeKey> key = randomKey();
    return key ? *key : ResumeKey{};
}

/// Whether the catalogue has a script for a scene of this name.
bool isScripted(const std::string& scene) {
    const CatalogEntry* entry = findInCatalog(scene);
    return entry != nullptr && entry->script != nullptr;
}

/// Only descriptors can run out here, before anything is opened; `Host::open` makes it a sentence.
void demand(int status, const char* what) {
    if (status == 0) return;
    throw std::runtime_error(std::string("no ") + what + ": " + uv_strerror(status));
}

}  // namespace

/// A session and when its ticks are due.
struct ClockedSession {
    Session* session = nullptr;
    TickClock clock;
};

struct Host::Inside {
    Inside(HostConfig given, std::optional<protocol::TlsContext> itsTls)
        : config(std::move(given)),
          tls(std::move(itsTls)),
          writer([this] { uv_async_send(&news); }),
          executor(config.threads > 1
                       ? std::make_unique<Executor>(config.threads, 0, nullptr, uv_hrtime)
                       : nullptr),
          hub({config.limits,
               config.fingerprint,
               config.log,
               {executor.get()},
               std::move(config.tickets),
               visitorsKey()},
              writer),
          sockets(loop, hub, tls ? &*tls : nullptr) {}
    ~Inside();

    /// The loop and the handles must be there before the writer's thread, which wakes them.
    struct Loop : uv_loop_t {
        Loop() { demand(uv_loop_init(this), "event loop"); }
    };

    Status start();
    [[nodiscard]] Status mayListenOn(const protocol::Address& bound) const;
    Status addSession(const SessionSpec& spec, Instant now);
    void closeDueTicks();
    void scheduleTicks();
    [[nodiscard]] Instant nextDeadline() const;
    void takeNews();
    void housekeeping();
    void beginStop();
    void endStop();
    void initHandles();

    HostConfig config;
    std::optional<protocol::TlsContext> tls;
    Loop loop;
    uv_async_t news{};
    uv_async_t stopper{};
    uv_timer_t ticks{};
    uv_idle_t late{};  ///< in place of the timer when a tick is due already
    uv_timer_t house{};
    uv_timer_t farewell{};
    uv_signal_t interrupt{};
    uv_signal_t terminate{};
    bool handlesReady = [this] {
        initHandles();
        return true;
    }();
    LogWriter writer;
    std::unique_ptr<Executor> executor;
    Hub hub;
    Sockets sockets;
    std::vector<ClockedSession> sessions;
    std::vector<std::shared_ptr<HostPart>> parts;
    std::string address;
    std::optional<std::string> failure;
    bool stopping = false;
};

void Host::Inside::initHandles() {
    const auto onNews = [](uv_async_t* handle) { static_cast<Inside*>(handle->data)->takeNews(); };
    const auto onStop = [](uv_async_t* handle) { static_cast<Inside*>(handle->data)->beginStop(); };
    demand(uv_async_init(&loop, &news, onNews), "wake-up for news");
    demand(uv_async_init(&loop, &stopper, onStop), "wake-up to stop");
    demand(uv_signal_init(&loop, &interrupt), "signal handle");
    demand(uv_signal_init(&loop, &terminate), "signal handle");
    // These take nothing of the system.
    uv_timer_init(&loop, &ticks);
    uv_timer_init(&loop, &house);
    uv_timer_init(&loop, &farewell);
    uv_idle_init(&loop, &late);
    news.data = stopper.data = ticks.data = late.data = house.data = farewell.data = this;
    interrupt.data = terminate.data = this;
}

Host::Inside::~Inside() {
    // If `run` never was: only the parts themselves can close what they opened.
    if (!stopping) {
        for (const auto& part : parts) part->stopping();
    }
    writer.finish();
    sockets.stopListening();
    sockets.closeAll();
    // Its own handles alone: the parts' close in an order of their own while the loop runs out.
    for (void* handle :
         {static_cast<void*>(&news), static_cast<void*>(&stopper), static_cast<void*>(&ticks),
          static_cast<void*>(&late), static_cast<void*>(&house), static_cast<void*>(&farewell),
          static_cast<void*>(&interrupt), static_cast<void*>(&terminate)}) {
        uv_close(static_cast<uv_handle_t*>(handle), nullptr);
    }
    uv_run(&loop, UV_RUN_DEFAULT);
    uv_loop_close(&loop);
}

Status Host::Inside::start() {
    Result<protocol::Address> listen = protocol::parseAddress(config.listen, true);
    if (!listen) return listen.error();
    if (config.sessions.empty()) return Error{"there is no session to host"};
    for (const SessionSpec& spec : config.sessions) {
        if (Status added = addSession(spec, uv_hrtime()); !added) return added;
    }
    // Phases are staggered, so that sessions do not all step at one moment.
    const auto count = static_cast<double>(hub.sessions().size());
    for (Session* session : hub.sessions()) {
        const double phase = static_cast<double>(sessions.size()) / count;
        sessions.push_back({session, TickClock(uv_hrtime(), session->ticksPerSecond(), phase,
                                               config.limits.catchUpTicks)});
    }
    if (Status listening = sockets.listen(*listen); !listening) return listening;
    if (Status may = mayListenOn(sockets.bound()); !may) return may;
    address = protocol::toText(sockets.bound());
    LogLine("listening").with("address", address).with("sessions", sessions.size()).to(config.log);
    return Done{};
}

Status Host::Inside::mayListenOn(const protocol::Address& bound) const {
    if (hub.asksForTickets() || config.open || protocol::isLoopback(bound)) return Done{};
    return Error{protocol::toText(bound) +
                 " can be reached from other machines, and anyone who does could join: give "
                 "--tickets with a key file (see huestep ticket --help), or --open if that is "
                 "meant"};
}

Status Host::Inside::addSession(const SessionSpec& spec, Instant now) {
    if (Status named = checkSessionName(spec.name); !named) return named;
    if (hub.find(spec.name)) return Error{"there are two sessions with the name " + spec.name};
    const std::string folder = config.data + "/" + spec.name;
    Result<std::unique_ptr<protocol::LogStore>> store = protocol::openFolder(folder);
    if (!store) return store.error();
    const Result<ResumeKey> key = randomKey();
    if (!key) return key.error();
    RecoveryRequest request{spec.name, config.fingerprint, &spec.scene, *key, {executor.get()}};
    Result<RecoveredSession> recovered = recoverSession(**store, request);
    if (!recovered) return recovered.error();
    if (recovered->otherScene) {
        LogLine("scene_kept")
            .with("session", spec.name)
            .with("text", folder + " holds a session of another scene, " + recovered->scene +
                              ", which goes on" +
                              (isScripted(recovered->scene) ? " without its script" : "") +
                              "; for " + spec.scene.name +
                              " take another session name or data folder")
            .to(config.log, Severity::Warning);
    } else {
        recovered->start.script = spec.script;
    }
    for (const std::string& why : recovered->contents.refusedSnapshots) {
        LogLine("snapshot_refused")
            .with("session", spec.name)
            .with("text", why)
            .to(config.log, Severity::Warning);
    }
    if (recovered->contents.tornBytes > 0) {
        LogLine("torn_tail")
            .with("session", spec.name)
            .with("file", recovered->contents.tornFile)
            .with("bytes", recovered->contents.tornBytes)
            .to(config.log, Severity::Warning);
    }
    Result<protocol::JournalWriter> journal = protocol::JournalWriter::open(
        **store, recovered->identity, recovered->contents, recovered->start.world.tick());
    if (!journal) return journal.error();
    writer.add(spec.name, std::move(*store), std::move(*journal));
    const Result<Session*> added = hub.add(std::move(recovered->start), now);
    if (!added) return added.error();
    return Done{};
}

void Host::Inside::scheduleTicks() {
    if (stopping || sessions.empty()) return;
    const Instant next = nextDeadline();
    const Instant now = uv_hrtime();
    if (next <= now) {
        // Once a turn of the loop, which then polls without waiting. A timer of 0 ms would be
        // called again before anything is read, for as long as the steps exceed their period.
        uv_idle_start(
            &late, [](uv_idle_t* handle) { static_cast<Inside*>(handle->data)->closeDueTicks(); });
        return;
    }
    uv_idle_stop(&late);
    // libuv's timers have milliseconds and never fire early: rounding up keeps a tick from being
    // looked for before it is due, and the deadlines themselves keep the remainder from adding up.
    const std::uint64_t wait = (next - now + millisecond - 1) / millisecond;
    uv_update_time(&loop);
    uv_timer_start(
        &ticks, [](uv_timer_t* handle) { static_cast<Inside*>(handle->data)->closeDueTicks(); },
        wait, 0);
}

/// Of the session that is due first.
Instant Host::Inside::nextDeadline() const {
    Instant next = ~Instant{0};
    for (const ClockedSession& s : sessions) next = std::min(next, s.clock.nextDeadline());
    return next;
}

void Host::Inside::closeDueTicks() {
    for (ClockedSession& s : sessions) {
        const std::uint64_t letGo = s.clock.letGo();
        const std::uint32_t due = s.clock.due(uv_hrtime());
        if (s.clock.letGo() > letGo) hub.noteLetGo(s.clock.letGo() - letGo);
        bool closed = false;
        for (std::uint32_t i = 0; i < due; ++i) {
            closed = hub.closeTick(*s.session, uv_hrtime()) || closed;
        }
        if (due > 0) sockets.flush(*s.session);
        if (!closed) continue;
        for (const auto& part : parts) part->afterTick(*s.session);
    }
    // At least one step of it each time, or a busy host would never name a desync.
    for (ClockedSession& s : sessions) {
        while (hub.work(*s.session) && uv_hrtime() + config.limits.spareTime < nextDeadline()) {
        }
    }
    scheduleTicks();
}

void Host::Inside::takeNews() {
    for (const JournalNews& item : writer.takeNews()) {
        if (!item.warning.empty()) {
            LogLine("snapshot_failed")
                .with("session", item.session)
                .with("text", item.warning)
                .to(config.log, Severity::Warning);
        }
        if (!item.failure) {
            hub.committed(item.session, item.commits);
            continue;
        }
        if (!failure) failure = "session " + item.session + ": " + *item.failure;
        hub.failed(item.session, *item.failure, uv_hrtime());
        sockets.flush();
    }
    const bool allFailed =
        std::all_of(sessions.begin(), sessions.end(),
                    [](const ClockedSession& s) { return s.session->failure().has_value(); });
    if (allFailed && !sessions.empty()) beginStop();
}

void Host::Inside::housekeeping() {
    hub.advance(uv_hrtime());
    sockets.flush();
    if (stopping && sockets.none()) endStop();
}

void Host::Inside::beginStop() {
    if (stopping) return;
    stopping = true;
    hub.stop(uv_hrtime());
    sockets.stopListening();
    sockets.flush();
    uv_timer_stop(&ticks);
    uv_idle_stop(&late);
    uv_signal_stop(&interrupt);
    uv_signal_stop(&terminate);
    for (const auto& part : parts) part->stopping();
    uv_timer_start(
        &farewell, [](uv_timer_t* handle) { static_cast<Inside*>(handle->data)->endStop(); },
        config.limits.farewellTime / millisecond, 0);
    uv_timer_start(
        &house, [](uv_timer_t* handle) { static_cast<Inside*>(handle->data)->housekeeping(); }, 0,
        10);
}

void Host::Inside::endStop() {
    sockets.closeAll();
    uv_timer_stop(&farewell);
    uv_timer_stop(&house);
    // Nothing of ours keeps the loop alive now: `uv_run` returns once the parts' handles are gone.
    uv_unref(reinterpret_cast<uv_handle_t*>(&news));
    uv_unref(reinterpret_cast<uv_handle_t*>(&stopper));
}

Host::Host(std::unique_ptr<Inside> inside) : m_inside(std::move(inside)) {}
Host::~Host() = default;

Result<std::unique_ptr<Host>> Host::open(HostConfig config) {
    // A client that is gone is an error of the write to it, not the end of the process.
    std::signal(SIGPIPE, SIG_IGN);
    if (!config.log) config.log = logToStandardError();
    std::optional<protocol::TlsContext> tls;
    if (config.tls) {
        auto made = protocol::TlsContext::forServer(config.tls->certificates, config.tls->key);
        if (!made) return made.error();
        tls.emplace(std::move(made).value());
    }
    std::unique_ptr<Inside> inside;
    try {
        inside = std::make_unique<Inside>(std::move(config), std::move(tls));
    } catch (const std::runtime_error& failure) {
        return Error{failure.what()};
    }
    if (Status started = inside->start(); !started) return started.error();
    return std::unique_ptr<Host>(new Host(std::move(inside)));
}

const std::string& Host::address() const {
    return m_inside->address;
}
Status Host::mayListenOn(const protocol::Address& bound) const {
    return m_inside->mayListenOn(bound);
}
const std::optional<TlsFiles>& Host::tls() const {
    return m_inside->config.tls;
}
uv_loop_s* Host::loop() {
    return &m_inside->loop;
}
const Hub& Host::hub() const {
    return m_inside->hub;
}
Hub& Host::hub() {
    return m_inside->hub;
}
void Host::add(std::shared_ptr<HostPart> part) {
    m_inside->parts.push_back(std::move(part));
}

Status Host::run() {
    Inside& in = *m_inside;
    if (in.config.handleSignals) {
        const auto onSignal = [](uv_signal_t* handle, int) {
            static_cast<Inside*>(handle->data)->beginStop();
        };
        uv_signal_start(&in.interrupt, onSignal, SIGINT);
        uv_signal_start(&in.terminate, onSignal, SIGTERM);
    }
    uv_timer_start(
        &in.house, [](uv_timer_t* handle) { static_cast<Inside*>(handle->data)->housekeeping(); },
        housekeepingMs, housekeepingMs);
    // Opening may have taken a while; the schedule starts now, not with ticks to catch up.
    for (ClockedSession& s : in.sessions) s.clock.restart(uv_hrtime());
    in.scheduleTicks();
    uv_run(&in.loop, UV_RUN_DEFAULT);
    in.writer.finish();
    in.takeNews();
    if (in.failure) return Error{*in.failure};
    return Done{};
}

void Host::stop() {
    uv_async_send(&m_inside->stopper);
}

}  // namespace huestep::server
