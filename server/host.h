/// A process that hosts sessions: sockets, files, clocks and threads around `Hub`.
///
///     HostConfig config;
///     config.listen = "127.0.0.1:0";
///     config.data = "data";                               // session NAME lives in data/NAME
///     config.sessions.push_back({"play", scene});
///     config.tickets = ...;                               // or config.open: anyone may join
///     config.fingerprint = ...;                           // what this build's self-test gave
///     Result<std::unique_ptr<Host>> host = Host::open(std::move(config));
///     if (!host) -> print host.error().message, exit 2
///     std::cout << "listening on " << (*host)->address() << std::endl;
///     Status ended = (*host)->run();                      // until SIGINT, SIGTERM or stop()
///
/// A session's folder holds the journal (protocol/journal.h) and beside it `scene.bin`
/// (protocol::writeSceneBinary: what tick 0 was built from) and `resume.key` (16 secret bytes).
/// A session whose folder exists goes on from it, whatever scene the config names. So a replay
/// from the start is: World::create(readScene(scene.bin)), then every Frame of the journal.
///
/// Thread rule: everything here belongs to the thread that calls `run`, except `stop`.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/parallel/executor.h"
#include "core/result.h"
#include "core/scene/scene.h"
#include "core/scene/script.h"
#include "protocol/address.h"
#include "protocol/messages.h"
#include "server/hub.h"
#include "server/limits.h"

struct uv_loop_s;

namespace huestep::server {

struct SessionSpec {
    std::string name;  ///< 1 to 64 of [a-z0-9_-]; also the folder's name
    Scene scene;       ///< used when the folder is new
    /// What the host does to the scene by itself, tick by tick. Its commands are journaled like
    /// any others; a session that is recovered goes on with it from its tick. It does not run where
    /// the folder holds another scene.
    Script script{};
};

struct TlsFiles {
    std::string certificates;  ///< the server's, and those that vouch for it
    std::string key;           ///< its private key
};

struct HostConfig {
    std::string listen = "127.0.0.1:7777";  ///< HOST:PORT; port 0: any free one
    std::string data = "huestep-data";      ///< created if missing
    std::vector<SessionSpec> sessions;
    /// Whose tickets let players in. None: anyone may join, and then `Host::open` refuses to listen
    /// where others than this machine's users come from, unless `open` says that this is meant.
    std::optional<TicketRules> tickets = std::nullopt;
    bool open = false;
    /// PEM files: with them players' connections and the page speak TLS 1.3.
    std::optional<TlsFiles> tls = std::nullopt;
    protocol::Fingerprint fingerprint;
    Limits limits;
    int threads = 1;            ///< that step the worlds, shared by all sessions
    bool handleSignals = true;  ///< SIGINT and SIGTERM end `run` cleanly
    LogSink log;                ///< none: `logToStandardError()`
};

/// A part of the host beside the TCP listener, such as the web endpoint. Called on the host's
/// thread; must not block. A part attaches its handles to `host.loop()` when it is made, and must
/// close them all in `stopping`, or `run` does not return.
class HostPart {
 public:
    virtual ~HostPart() = default;
    /// After a session closed a tick: `session.view(withShapes)` is what to draw.
    virtual void afterTick(const Session& session) = 0;
    virtual void stopping() = 0;
};

class Host {
 public:
    /// Opens or recovers every session, binds the address. Sentences name file or address.
    /// From then on the process ignores SIGPIPE: a client may go at any time.
    static Result<std::unique_ptr<Host>> open(HostConfig config);
    ~Host();
    Host(const Host&) = delete;
    Host& operator=(const Host&) = delete;

    /// HOST:PORT it listens on, the port as bound.
    [[nodiscard]] const std::string& address() const;
    /// Whether a door may stand there: not open to others than this machine's users, unless it is
    /// meant to be. For parts that listen too. The sentence names the address and what to give.
    [[nodiscard]] Status mayListenOn(const protocol::Address& bound) const;
    [[nodiscard]] uv_loop_s* loop();
    /// For parts that listen too. None: no TLS.
    [[nodiscard]] const std::optional<TlsFiles>& tls() const;
    /// Sessions and counters.
    [[nodiscard]] const Hub& hub() const;
    /// For parts through which clients come: as a transport uses it.
    [[nodiscard]] Hub& hub();

    void add(std::shared_ptr<HostPart> part);  ///< before `run`

    /// Serves until a signal or `stop`: then Bye to all, the journals flushed, a snapshot of each
    /// session written. Fails if a journal did: the sentence names the file.
    Status run();

    /// Ends `run`; from any thread, or from a signal handler.
    void stop();

 private:
    struct Inside;
    explicit Host(std::unique_ptr<Inside> inside);
    std::unique_ptr<Inside> m_inside;
};

}  // namespace huestep::server
