#include "server/visitors.h"

#include <arpa/inet.h>

#include <array>
#include <cstring>
#include <span>

#include "protocol/address.h"

namespace huestep::server {

namespace {

/// HOST of HOST:PORT or of [HOST]:PORT.
std::string hostOf(std::string_view peer) {
    const Result<protocol::Address> address = protocol::parseAddress(peer, true);
    return address ? address->host : std::string(peer);
}

}  // namespace

std::string visitorOf(std::string_view peer) {
    const std::string host = hostOf(peer);
    in6_addr number{};
    if (inet_pton(AF_INET6, host.c_str(), &number) != 1) return host;
    std::array<char, INET6_ADDRSTRLEN> text{};
    if (IN6_IS_ADDR_V4MAPPED(&number)) {
        // As a listener of both families sees an IPv4 number: its /64 is everybody's.
        inet_ntop(AF_INET, number.s6_addr + 12, text.data(), text.size());
        return text.data();
    }
    if (IN6_IS_ADDR_LOOPBACK(&number)) return host;
    std::memset(number.s6_addr + 8, 0, 8);
    inet_ntop(AF_INET6, &number, text.data(), text.size());
    return std::string(text.data()) + "/64";
}

bool isShared(std::string_view visitor) {
    return protocol::isLoopback({std::string(visitor), 0});
}

Visitors::Visitors(const Limits& limits, const ResumeKey& key, Instant now)
    : m_limits(limits),
      m_key(key),
      m_rates(limits.rateBuckets, TokenBucket(limits.acceptsPerSecond, limits.acceptBurst, now)) {}

bool Visitors::mayCome(const std::string& visitor, Instant now) {
    if (isShared(visitor)) return true;
    const auto here = m_here.find(visitor);
    if (here != m_here.end() && here->second >= m_limits.connectionsPerAddress) return false;
    const std::span<const char> text(visitor);
    const std::uint64_t hash =
        sipHash(m_key, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
    return m_rates[hash % m_rates.size()].take(now);
}

void Visitors::came(const std::string& visitor) {
    ++m_here[visitor];
}

void Visitors::left(const std::string& visitor) {
    const auto here = m_here.find(visitor);
    if (here != m_here.end() && --here->second == 0) m_here.erase(here);
}

}  // namespace huestep::server
