#include "protocol/ticket.h"

#include <algorithm>

#include "protocol/bytes.h"
#include "protocol/codec.h"

namespace huestep::protocol {

namespace {

constexpr std::string_view purpose = "huestep ticket 1";
constexpr std::uint8_t ticketVersion = 1;
// Where each field lies; the names follow.
constexpr std::size_t versionAt = 0, roleAt = 1, issuedAt = 2, expiresAt = 10, idAt = 18;
constexpr std::size_t sessionSizeAt = 34, playerSizeAt = 35, fixedBytes = 36;
constexpr std::size_t signatureBytes = std::tuple_size_v<Signature>;
static_assert(fixedBytes + maxSessionName + maxPlayerName + signatureBytes + sealBytes <=
              maxTicketBytes);

/// What is wrong with the fields, whoever wrote them.
Status checkFields(const Ticket& ticket) {
    if (!isSessionName(ticket.session))
        return Error{"session: not a name of 1 to 64 of a-z, 0-9, _ and -"};
    if (!isPlayerName(ticket.player))
        return Error{"player: not a name of 1 to 32 of a-z, 0-9, _ and -"};
    if (ticket.role > Role::Spectator) return Error{"role: neither player nor spectator"};
    if (ticket.expires <= ticket.issued) return Error{"expires: not after it was issued"};
    if (ticket.expires - ticket.issued > 1'000 * maxTicketSeconds)
        return Error{"expires: more than " + std::to_string(maxTicketSeconds) + " s ahead"};
    return Done{};
}

std::vector<std::byte> write(const Ticket& ticket) {
    const std::string names = ticket.session + ticket.player;
    std::vector<std::byte> out(fixedBytes + names.size());
    store(out, versionAt, ticketVersion);
    store(out, roleAt, ticket.role);
    store(out, issuedAt, ticket.issued);
    store(out, expiresAt, ticket.expires);
    store(out, idAt, ticket.id);
    store(out, sessionSizeAt, static_cast<std::uint8_t>(ticket.session.size()));
    store(out, playerSizeAt, static_cast<std::uint8_t>(ticket.player.size()));
    std::memcpy(out.data() + fixedBytes, names.data(), names.size());
    return out;
}

}  // namespace

bool isPlayerName(std::string_view name) {
    return name.size() <= maxPlayerName && isSessionName(name);
}

Result<Ticket> parseTicket(std::span<const std::byte> plain) {
    if (plain.size() < fixedBytes) return Error{"this ticket is cut short"};
    const auto version = load<std::uint8_t>(plain, versionAt);
    if (version != ticketVersion)
        return Error{"this ticket is of version " + std::to_string(version) + ", not 1"};
    const std::size_t session = load<std::uint8_t>(plain, sessionSizeAt);
    const std::size_t player = load<std::uint8_t>(plain, playerSizeAt);
    if (plain.size() != fixedBytes + session + player)
        return Error{"this ticket's names are cut short or too long"};
    const std::string names(reinterpret_cast<const char*>(plain.data()) + fixedBytes,
                            session + player);
    const Ticket ticket{names.substr(0, session),
                        static_cast<Role>(load<std::uint8_t>(plain, roleAt)),
                        names.substr(session),
                        load<std::uint64_t>(plain, issuedAt),
                        load<std::uint64_t>(plain, expiresAt),
                        load<TicketId>(plain, idAt)};
    if (const Status fields = checkFields(ticket); !fields)
        return Error{"this ticket's " + fields.error().message};
    return ticket;
}

Result<std::vector<std::byte>> sealTicket(const Ticket& ticket, const Keys& keys,
                                          const SealNonce& nonce) {
    if (!keys.signing || !keys.sealing)
        return Error{"tickets are made with a signing and a sealing key, and these keys lack one"};
    if (const Status fields = checkFields(ticket); !fields) return fields.error();
    std::vector<std::byte> plain = write(ticket);
    const Signature signature = sign(*keys.signing, purpose, plain);
    for (const std::uint8_t byte : signature) plain.push_back(std::byte{byte});
    return seal(*keys.sealing, nonce, plain);
}

Result<Ticket> openTicket(std::span<const std::byte> sealed, const VerifyingKey& verifying,
                          const SecretKey& sealing) {
    const auto forged = [] { return Error{"no issuer of this server's made this ticket"}; };
    const std::optional<std::vector<std::byte>> opened = unseal(sealing, sealed);
    if (!opened || opened->size() < signatureBytes) return forged();
    const auto plain = std::span(*opened).first(opened->size() - signatureBytes);
    Signature signature{};
    const auto mark = std::span(*opened).last(signatureBytes);
    std::transform(mark.begin(), mark.end(), signature.begin(),
                   [](std::byte b) { return std::to_integer<std::uint8_t>(b); });
    if (!verify(verifying, purpose, plain, signature)) return forged();
    return parseTicket(plain);
}

}  // namespace huestep::protocol
