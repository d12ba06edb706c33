/// `huestep ticket`: makes the keys of tickets, signs tickets, shows them.
#include <cstdio>
#include <memory>

#include "protocol/ticket.h"
#include "tools/clock.h"
#include "tools/command.h"
#include "tools/key_files.h"
#include "tools/text.h"
#include "tools/ticket_text.h"
#include "tools/whole_number.h"

namespace huestep::tools {
namespace {

struct Options {
    std::string action;
    std::string name;  ///< of `key`, how files begin; of `show`, a file
    std::string key;
    std::string session;
    std::string player = "guest";
    std::string role = "player";
    std::uint64_t expires = protocol::ticketSeconds;
    bool json = false;
};

Answer makeKeyFiles(const Options& options) {
    if (options.name.empty()) return Error{"ticket key: say how the files' names begin"};
    const protocol::Keys keys = protocol::makeKeys(true);
    const std::string issuer = options.name + ".issuer.key";
    const std::string host = options.name + ".host.key";
    if (const Status written = writeKeyFile(issuer, keys); !written) return written.error();
    if (const Status written = writeKeyFile(host, protocol::withoutSigning(keys)); !written)
        return written.error();
    std::printf(
        "%s  for who issues tickets: huestep ticket issue --key %s\n"
        "%s  for hosts: huestep serve --tickets %s\n",
        issuer.c_str(), issuer.c_str(), host.c_str(), host.c_str());
    return Exit::Done;
}

Result<protocol::Keys> keysOf(const Options& options) {
    if (options.key.empty())
        return Error{"ticket " + options.action +
                     ": --key FILE is missing; huestep ticket key "
                     "makes one"};
    return readKeyFile(options.key);
}

Answer issue(const Options& options) {
    const Result<protocol::Keys> keys = keysOf(options);
    if (!keys) return keys.error();
    if (options.session.empty()) return Error{"ticket issue: --session NAME is missing"};
    if (options.role != "player" && options.role != "spectator")
        return Error{"--role: '" + options.role + "' is neither player nor spectator"};
    protocol::Ticket ticket;
    ticket.session = options.session;
    ticket.player = options.player;
    ticket.role = options.role == "player" ? protocol::Role::Player : protocol::Role::Spectator;
    ticket.issued = wallMilliseconds();
    ticket.expires = ticket.issued + 1'000 * options.expires;
    protocol::fillRandom(ticket.id);
    protocol::SealNonce nonce{};
    protocol::fillRandom(nonce);
    const Result<std::vector<std::byte>> sealed = protocol::sealTicket(ticket, *keys, nonce);
    if (!sealed) return Error{options.key + ": " + sealed.error().message};
    std::printf("%s\n", protocol::toUrlText(*sealed).c_str());
    return Exit::Done;
}

Answer show(const Options& options) {
    const Result<protocol::Keys> keys = keysOf(options);
    if (!keys) return keys.error();
    if (!keys->verifying || !keys->sealing)
        return Error{options.key + ": a ticket is opened with a verifying and a sealing key"};
    const std::string file = options.name.empty() ? "-" : options.name;
    const Result<std::vector<std::byte>> sealed = readTicket(file);
    if (!sealed) return sealed.error();
    const auto ticket = protocol::openTicket(*sealed, *keys->verifying, *keys->sealing);
    if (!ticket) return ticket.error();
    const std::uint64_t now = wallMilliseconds();
    const double left = 1e-3 * (static_cast<double>(ticket->expires) - static_cast<double>(now));
    const char* role = ticket->role == protocol::Role::Player ? "player" : "spectator";
    if (options.json) {
        print({{"session", ticket->session},
               {"player", ticket->player},
               {"role", role},
               {"issued_ms", ticket->issued},
               {"expires_ms", ticket->expires},
               {"seconds_left", left}});
    } else {
        std::printf("session  %s\nplayer   %s\nrole     %s\n%s %s s\n", ticket->session.c_str(),
                    ticket->player.c_str(), role, left < 0.0 ? "expired " : "expires in",
                    number(left < 0.0 ? -left : left).c_str());
    }
    return left < 0.0 ? Exit::Differs : Exit::Done;
}

Answer run(const Options& options) {
    if (options.action == "key") return makeKeyFiles(options);
    if (options.action == "issue") return issue(options);
    if (options.action == "show") return show(options);
    return Error{"ticket: '" + options.action + "' is none of key, issue and show"};
}

}  // namespace

void addTicket(Menu& menu) {
    const auto o = std::make_shared<Options>();
    CLI::App* sub = menu.add(
        "ticket",
        "Tickets let one player into one session, once, for a short time (docs/tickets.md).\n"
        "  ticket key NAME    makes NAME.issuer.key and NAME.host.key\n"
        "  ticket issue       prints a ticket\n"
        "  ticket show FILE   says what a ticket is for; status 1: it has expired",
        "huestep ticket key club\n"
        "  huestep ticket issue --key club.issuer.key --session play --player ann > ann.ticket\n"
        "  huestep ticket show ann.ticket --key club.host.key",
        [o] { return run(*o); });
    sub->add_option("ACTION", o->action, "key, issue or show")->required();
    sub->add_option("NAME", o->name,
                    "With key: how the two files' names begin; with show: a file, -: standard "
                    "input (default)");
    sub->add_option("--key", o->key, "Key file to sign with, or to open with");
    sub->add_option("--session", o->session, "Session that it is for");
    sub->add_option("--player", o->player,
                    "Who comes, as you know him: 1 to 32 of a-z, 0-9, _ and - (default: guest)");
    sub->add_option("--role", o->role, "player or spectator (default: player)");
    sub->add_option("--expires", o->expires, "Seconds that it holds (default: 45)")
        ->transform(wholeNumber(1, protocol::maxTicketSeconds));
    sub->add_flag("--json", o->json, "With show: print one JSON document");
}

}  // namespace huestep::tools
