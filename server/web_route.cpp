#include "server/web_route.h"

#include <algorithm>
#include <cctype>

#include "server/web_assets.h"

namespace huestep::server {

namespace {

constexpr std::string_view html = "text/html; charset=utf-8";

struct Words {
    std::string_view heading;
    std::string_view sentence;
};

Words wordsOf(unsigned status) {
    switch (status) {
        case 403:
            return {"Not from there", "A session is watched from the page of its own server."};
        case 405:
            return {"Only GET", "This address can be read, and nothing else."};
        case 426:
            return {"A WebSocket lives here", "Open the session's page to watch it."};
        case 429:
            return {"Too many requests", "Wait a moment, then try again."};
        case 503:
            return {"Full", "As many people are watching as this server allows. Try again later."};
        default:
            return {"Nothing here", "There is no such page on this server."};
    }
}

void replaceOnce(std::string& text, std::string_view marker, std::string_view with) {
    const std::size_t at = text.find(marker);
    if (at != std::string::npos) text.replace(at, marker.size(), with);
}

std::string counted(std::size_t count, std::string_view one, std::string_view many) {
    return std::to_string(count) + " " + std::string(count == 1 ? one : many);
}

/// Names are of [a-z0-9_-] (protocol::isSessionName), so they stand in HTML as they are.
std::string listOf(std::span<const WebSession> sessions) {
    if (sessions.empty()) return "";
    std::string list = "<ul>";
    for (const WebSession& session : sessions) {
        list += "<li><a href=\"/?session=" + session.name + "\"><b>" + session.name + "</b><span>";
        list += counted(session.bodies, "body", "bodies") + ", ";
        list += counted(session.players, "player", "players") + ", tick ";
        list += std::to_string(session.tick) + "</span></a></li>";
    }
    return list + "</ul>";
}

WebReply page(unsigned status, const Words& words, std::span<const WebSession> sessions) {
    WebReply reply{status, html, {}, {}};
    const WebAsset* frame = findWebAsset("message.html");
    if (frame) reply.body = frame->body;
    replaceOnce(reply.body, "<!--heading-->", words.heading);
    replaceOnce(reply.body, "<!--heading-->", words.heading);
    replaceOnce(reply.body, "<!--sentence-->", words.sentence);
    replaceOnce(reply.body, "<!--sessions-->", listOf(sessions));
    return reply;
}

WebReply assetNamed(std::string_view name) {
    const WebAsset* asset = findWebAsset(name);
    if (!asset) return refusal(404);
    return {200, asset->type, std::string(asset->body), {}, asset->encoding};
}

WebReply rootOf(const WebRequest& request, std::span<const WebSession> sessions) {
    if (request.session) {
        const bool known = std::any_of(sessions.begin(), sessions.end(), [&](const WebSession& s) {
            return s.name == *request.session;
        });
        if (known) return assetNamed("index.html");
        return page(404, {"No such session", "This server has no session of that name."}, sessions);
    }
    if (sessions.size() == 1) {
        return {302, html, {}, "/?session=" + sessions.front().name};
    }
    return page(200, {"Sessions", "Choose one to watch."}, sessions);
}

}  // namespace

WebReply refusal(unsigned status, std::span<const WebSession> sessions) {
    return page(status, wordsOf(status), sessions);
}

WebReply answer(const WebRequest& request, std::span<const WebSession> sessions) {
    if (request.method != "GET" && request.method != "HEAD") return refusal(405);
    if (request.path == "/") return rootOf(request, sessions);
    if (request.path == viewPath || request.path == peerPath) return refusal(426, sessions);
    // Frames of pages are no pages, and index.html needs a session: both go through `/`.
    if (request.path.empty() || request.path.ends_with(".html")) return refusal(404);
    return assetNamed(std::string_view(request.path).substr(1));
}

bool sameOrigin(std::string_view origin, std::string_view host) {
    if (origin.empty()) return true;
    const std::size_t scheme = origin.find("://");
    if (scheme == std::string_view::npos) return false;
    const std::string_view authority = origin.substr(scheme + 3);
    const auto same = [](char a, char b) {
        return std::tolower(static_cast<unsigned char>(a)) ==
               std::tolower(static_cast<unsigned char>(b));
    };
    return std::equal(authority.begin(), authority.end(), host.begin(), host.end(), same);
}

}  // namespace huestep::server
