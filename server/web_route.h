/// What the web endpoint answers to a request: a pure function, without I/O.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace huestep::server {

struct WebRequest {
    std::string method = "GET";
    std::string path = "/";  ///< percent-decoded
    /// Value of `session` in the query, if it is there.
    std::optional<std::string> session;
};

/// A session as the list shows it.
struct WebSession {
    std::string name;
    std::uint64_t tick = 0;
    std::size_t bodies = 0;
    std::size_t players = 0;  ///< connected
};

struct WebReply {
    unsigned status = 200;
    std::string_view type;
    std::string body;
    std::string location;         ///< of a redirect
    std::string_view encoding{};  ///< of the body, if it has one
};

inline constexpr std::string_view viewPath = "/view";  ///< of the WebSocket of who watches
inline constexpr std::string_view peerPath = "/peer";  ///< of that of who steps the world

///   /                 the session, if there is one; else the list of sessions
///   /?session=NAME    the page; 404 without such a session
///   /FILE             a file of the page (server/web_assets.h), by its whole name
///   /view, /peer      426: they are WebSockets
///   else              404
WebReply answer(const WebRequest& request, std::span<const WebSession> sessions);

/// An answer that is no page: a heading and a sentence in HTML.
WebReply refusal(unsigned status, std::span<const WebSession> sessions = {});

/// Whether a browser's WebSocket comes from our own page. A program sends no origin.
bool sameOrigin(std::string_view origin, std::string_view host);

}  // namespace huestep::server
