/// Who comes from where: what one address may take of the doors that all share.
///
/// An address is an IPv4 number or the /64 of an IPv6 number, since whoever has one of these has
/// them all. Of a loopback address nothing is counted: behind it are all users of this machine, or
/// a proxy and all who come through it. Thread rule: one at a time.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "server/limits.h"
#include "server/resume_token.h"
#include "server/token_bucket.h"

namespace huestep::server {

/// Of a peer as protocol::toText writes it, HOST:PORT, or of a host alone: "192.0.2.7",
/// "2001:db8:0:1::/64". What is no number is taken as it is.
std::string visitorOf(std::string_view peer);

class Visitors {
 public:
    /// `key` keeps others from finding addresses that share a bucket.
    Visitors(const Limits& limits, const ResumeKey& key, Instant now);

    /// Whether one more connection may come from there, counting those that `came`.
    bool mayCome(const std::string& visitor, Instant now);
    void came(const std::string& visitor);
    void left(const std::string& visitor);
    /// Addresses with a connection.
    [[nodiscard]] std::size_t known() const { return m_here.size(); }

 private:
    Limits m_limits;
    ResumeKey m_key;
    std::map<std::string, std::uint32_t> m_here;  ///< connections by address
    std::vector<TokenBucket> m_rates;             ///< by a hash of the address: bounded
};

/// Whether limits by address do not hold for this visitor.
bool isShared(std::string_view visitor);

}  // namespace huestep::server
