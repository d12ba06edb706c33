#include "server/web_peer.h"

#include <uv.h>

#include <algorithm>

namespace huestep::server {

std::optional<WebPeer> WebPeer::accept(Hub& hub, std::string address, Instant now) {
    const std::optional<ConnectionId> id = hub.accept(std::move(address), now);
    if (!id) return std::nullopt;
    return WebPeer(hub, *id);
}

WebPeer::~WebPeer() {
    if (m_hub) m_hub->closed(m_id, uv_hrtime());
}

void WebPeer::receive(std::span<const std::byte> bytes, Instant now) {
    m_hub->receive(m_id, bytes, now);
}

std::vector<unsigned char> WebPeer::next(std::size_t room, Instant now) {
    std::vector<unsigned char> message(room);
    while (message.size() < room + messageBytes) {
        const SharedBytes piece = m_hub->next(m_id, message.size() - room, now);
        if (!piece) break;
        const auto* const from = reinterpret_cast<const unsigned char*>(piece->data());
        message.insert(message.end(), from, from + piece->size());
    }
    return message;
}

bool WebPeer::follows(const Session& session) const {
    const Connection* const connection = m_hub->connection(m_id);
    return connection && connection->session() == &session;
}

}  // namespace huestep::server
