/// `huestep serve`: hosts sessions.
#include <cstdio>
#include <memory>

#include "protocol/fingerprint.h"
#include "server/host.h"
#include "server/log.h"
#include "server/web_endpoint.h"
#include "tools/clock.h"
#include "tools/command.h"
#include "tools/interrupt.h"
#include "tools/key_files.h"
#include "tools/scene_source.h"
#include "tools/serve_config.h"

namespace huestep::tools {
namespace {

Result<server::SessionSpec> parseSession(const std::string& text) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == text.size())
        return Error{"--session: '" + text + "' is not NAME=SCENE, as in play=sandbox"};
    Result<NamedScene> scene = loadScene(text.substr(equals + 1));
    if (!scene) return Error{"--session " + text + ": " + scene.error().message};
    return server::SessionSpec{text.substr(0, equals), std::move(scene->scene),
                               std::move(scene->script)};
}

Result<server::TicketRules> ticketRules(const std::string& file) {
    const Result<protocol::Keys> keys = readKeyFile(file);
    if (!keys) return keys.error();
    if (keys->signing)
        return Error{file +
                     ": with this key tickets are made, and a host must not hold it; give "
                     "the NAME.host.key that huestep ticket key made beside it"};
    if (!keys->verifying || !keys->sealing)
        return Error{file +
                     ": a host checks tickets with a verifying and a sealing key, and one "
                     "of them is missing; huestep ticket key makes both"};
    return server::TicketRules{*keys->verifying, *keys->sealing, wallMilliseconds};
}

Result<server::HostConfig> configOf(const ServeOptions& options) {
    server::HostConfig config;
    if (!options.listen.empty()) config.listen = options.listen;
    if (!options.data.empty()) config.data = options.data;
    config.open = options.open;
    if (!options.tickets.empty()) {
        if (options.open)
            return Error{"--tickets and --open: either players show tickets, or anyone may join"};
        Result<server::TicketRules> rules = ticketRules(options.tickets);
        if (!rules) return rules.error();
        config.tickets = std::move(*rules);
    }
    if (options.tlsCertificates.empty() != options.tlsKey.empty())
        return Error{"--tls-cert and --tls-key: one is nothing without the other"};
    if (!options.tlsKey.empty())
        config.tls = server::TlsFiles{options.tlsCertificates, options.tlsKey};
    const Result<InputDelay> delay = parseInputDelay(options.inputDelay);
    if (!delay) return Error{"--" + delay.error().message};
    config.limits.inputDelay = delay->least;
    config.limits.maxInputDelay = delay->most;
    if (options.sessions.empty())
        return Error{"--session: give at least one, as in --session play=sandbox"};
    for (const std::string& text : options.sessions) {
        Result<server::SessionSpec> session = parseSession(text);
        if (!session) return session.error();
        config.sessions.push_back(std::move(session).value());
    }
    const Result<protocol::Fingerprint> fingerprint = protocol::selfTest();
    if (!fingerprint) return fingerprint.error();
    config.fingerprint = *fingerprint;
    return config;
}

/// Ends a host by a signal that comes before the host's loop has handlers of its own.
class StopHost final : public InterruptHook {
 public:
    explicit StopHost(server::Host& host) : m_host(host) {}
    void interrupt() override { m_host.stop(); }

 private:
    server::Host& m_host;
};

Answer serve(ServeOptions options) {
    if (const Status filled = fillFromFile(options); !filled) return filled.error();
    Result<server::HostConfig> config = configOf(options);
    if (!config) return config.error();
    if (interrupted()) return Exit::Done;
    const bool tickets = config->tickets.has_value();
    const bool open = config->open;
    Result<std::unique_ptr<server::Host>> host = server::Host::open(std::move(config).value());
    if (!host) return host.error();
    std::string page;
    if (!options.web.empty()) {
        const auto web =
            server::WebEndpoint::open(**host, {options.web, {}, server::logToStandardError()});
        if (!web) return web.error();
        page = (options.tlsKey.empty() ? "http://" : "https://") + (*web)->address() + "/";
    }
    if (open)
        std::fprintf(stderr, "warning: --open: whoever reaches %s may play, without a ticket\n",
                     (*host)->address().c_str());
    else if (!tickets)
        std::fprintf(stderr,
                     "no --tickets: whoever uses this machine may play at %s; others cannot reach "
                     "it\n",
                     (*host)->address().c_str());
    std::printf("listening on %s\n", (*host)->address().c_str());
    if (!page.empty()) std::printf("page %s\n", page.c_str());
    std::fflush(stdout);
    StopHost stop(**host);
    const HookedInterrupt hooked(stop);
    const Status ended = (*host)->run();
    if (ended) return Exit::Done;
    std::fprintf(stderr, "huestep: %s\n", ended.error().message.c_str());
    return Exit::Differs;
}

}  // namespace

void addServe(Menu& menu) {
    const auto o = std::make_shared<ServeOptions>();
    CLI::App* sub = menu.add(
        "serve", "Hosts sessions; the journal of session NAME is the folder DIR/NAME.",
        "huestep serve --listen 127.0.0.1:7777 --data huestep-data --session play=sandbox --open",
        [o] { return serve(*o); });
    sub->add_option("--config", o->config, "TOML file with these options; the command line wins");
    sub->add_option("--listen", o->listen,
                    "HOST:PORT for players; port 0: any free one (default: 127.0.0.1:7777)");
    sub->add_option("--web", o->web,
                    "HOST:PORT for a page that shows the sessions; port 0: any free one");
    sub->add_option("--data", o->data, "Folder of the journals (default: huestep-data)");
    sub->add_option("--session", o->sessions, "NAME=SCENE; may be given several times");
    sub->add_option("--input-delay", o->inputDelay,
                    "Ticks from an input to its frame: N, or LOW-HIGH between which clients that "
                    "predict adapt to their round trip, or adaptive: 0-12 (default: 0)");
    sub->add_option("--tickets", o->tickets,
                    "Let in who shows a ticket of the issuer of this key file (huestep ticket "
                    "key), which all who come from other machines must unless --open is given");
    sub->add_option("--tls-cert", o->tlsCertificates,
                    "PEM file of the server's certificate, and of those that vouch for it: with "
                    "--tls-key, players and page speak TLS 1.3");
    sub->add_option("--tls-key", o->tlsKey, "PEM file of its private key");
    sub->add_flag("--open", o->open, "Let anyone join without a ticket, from wherever");
}

}  // namespace huestep::tools
