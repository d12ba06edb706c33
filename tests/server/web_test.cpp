// The web endpoint without a browser: its answers, what waits for a viewer, and its life in a host.
#include <dlfcn.h>
#include <gtest/gtest.h>
#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
#include <string_view>
#include <thread>

#include "core/scene/catalog.h"
#include "protocol/codec.h"
#include "server/web_assets.h"
#include "server/web_endpoint.h"
#include "server/web_listener.h"
#include "server/web_route.h"
#include "server/web_viewer.h"

// Takes the place of the C library's in this program, for one name whose first number cannot be
// bound here: that it is of another machine is what documentation numbers are for.
extern "C" int getaddrinfo(const char* name, const char* port, const addrinfo* hints,
                           addrinfo** out) {
    using Look = int (*)(const char*, const char*, const addrinfo*, addrinfo**);
    static const auto look = reinterpret_cast<Look>(::dlsym(RTLD_NEXT, "getaddrinfo"));
    if (name == nullptr || std::string_view(name) != "two-numbers.test") {
        return look(name, port, hints, out);
    }
    addrinfo* second = nullptr;
    const int failed = look("192.0.2.1", port, hints, out);
    if (failed != 0 || look("127.0.0.1", port, hints, &second) != 0) return EAI_FAIL;
    (*out)->ai_next = second;
    return 0;
}

namespace huestep::server {
namespace {

/// How every frame of a View begins.
std::array<std::byte, 4> viewMagic() {
    const std::vector<std::byte> frame = protocol::encode(protocol::View{});
    std::array<std::byte, 4> out{};
    std::copy_n(frame.begin(), out.size(), out.begin());
    return out;
}

const std::vector<WebSession> two{{"arena", 60, 12, 3}, {"pile", 0, 1, 0}};

TEST(WebRoute, OneSessionIsChosenByItselfAndSeveralAreListed) {
    const WebReply alone = answer({}, {two.data(), 1});
    EXPECT_EQ(alone.status, 302u);
    EXPECT_EQ(alone.location, "/?session=arena");
    const WebReply list = answer({}, two);
    EXPECT_EQ(list.status, 200u);
    EXPECT_NE(list.body.find("/?session=arena"), std::string::npos);
    EXPECT_NE(list.body.find("/?session=pile"), std::string::npos);
    EXPECT_NE(list.body.find("3 players"), std::string::npos);
    EXPECT_EQ(answer({}, {}).status, 200u);
}

TEST(WebRoute, AnUnknownSessionIs404AndItsNameIsNotRepeated) {
    const WebReply reply = answer({"GET", "/", "<script>"}, two);
    EXPECT_EQ(reply.status, 404u);
    EXPECT_EQ(reply.body.find("<script>"), std::string::npos);
    EXPECT_EQ(answer({"GET", "/", ""}, two).status, 404u);
    EXPECT_EQ(answer({"GET", "/", "pile"}, two).status, 200u);
}

TEST(WebRoute, EveryFileOfThePageHasOneNameAndNothingElseHasAny) {
    ASSERT_GT(webAssets().size(), 5u);
    for (const WebAsset& asset : webAssets()) {
        const WebReply reply = answer({"GET", "/" + std::string(asset.name), {}}, two);
        const bool frame = asset.name.ends_with(".html");
        EXPECT_EQ(reply.status, frame ? 404u : 200u) << asset.name;
        if (frame) continue;
        EXPECT_EQ(reply.body, asset.body) << asset.name;
    }
    for (const char* path : {"/..", "/../main.js", "/./main.js", "//main.js", "/main.js/",
                             "/MAIN.JS", "main.js", "", "/web_assets.h", "/etc/passwd"}) {
        EXPECT_EQ(answer({"GET", path, {}}, two).status, 404u) << path;
    }
}

TEST(WebRoute, NoScriptOrStyleStandsInAPageSoThatThePolicyMayForbidThem) {
    for (const WebAsset& asset : webAssets()) {
        if (!asset.name.ends_with(".html")) continue;
        EXPECT_EQ(asset.body.find(" style="), std::string_view::npos) << asset.name;
        EXPECT_EQ(asset.body.find("<style"), std::string_view::npos) << asset.name;
        EXPECT_EQ(asset.body.find(" onclick="), std::string_view::npos) << asset.name;
        EXPECT_EQ(asset.body.find("<script>"), std::string_view::npos) << asset.name;
        EXPECT_EQ(asset.body.find("//"), std::string_view::npos)
            << asset.name << " loads elsewhere";
    }
}

TEST(WebRoute, OnlyReadingIsAnswered) {
    EXPECT_EQ(answer({"HEAD", "/main.js", {}}, two).status, 200u);
    EXPECT_EQ(answer({"POST", "/main.js", {}}, two).status, 405u);
    EXPECT_EQ(answer({"GET", "/view", "pile"}, two).status, 426u);
}

TEST(WebRoute, AViewerComesFromThePageOfTheSameHost) {
    EXPECT_TRUE(sameOrigin("", "127.0.0.1:8080"));
    EXPECT_TRUE(sameOrigin("http://LocalHost:8080", "localhost:8080"));
    EXPECT_FALSE(sameOrigin("http://elsewhere.example", "127.0.0.1:8080"));
    EXPECT_FALSE(sameOrigin("http://127.0.0.1:8081", "127.0.0.1:8080"));
    EXPECT_FALSE(sameOrigin("null", "null"));
    EXPECT_FALSE(sameOrigin("http://127.0.0.1:8080.example", "127.0.0.1:8080"));
}

SharedWebFrame frame() {
    return std::make_shared<WebFrame>();
}

TEST(WebViewer, TheNewestFrameTakesThePlaceOfTheOneThatWaits) {
    WebViewer viewer;
    const SharedWebFrame first = frame();
    const SharedWebFrame second = frame();
    viewer.offer(first, 1);
    viewer.offer(second, 1);
    EXPECT_EQ(first.use_count(), 1);  // what was dropped is not kept
    EXPECT_EQ(viewer.take(), second);
    EXPECT_EQ(viewer.take(), nullptr);
    EXPECT_EQ(viewer.dropped(), 1u);
}

TEST(WebViewer, ShapesAreNeededUntilAFrameOfTheirDefinitionsWasHandedOut) {
    WebViewer viewer;
    EXPECT_TRUE(viewer.needsShapes(1));
    viewer.offer(frame(), 1);
    EXPECT_TRUE(viewer.needsShapes(1)) << "not handed out yet, and may still be dropped";
    viewer.take();
    EXPECT_FALSE(viewer.needsShapes(1));
    EXPECT_TRUE(viewer.needsShapes(2));
}

class WebHost : public testing::Test {
 protected:
    WebHost() {
        HostConfig config;
        config.listen = "127.0.0.1:0";
        config.data = data;
        config.sessions.push_back({"pile", sceneFromCatalog("pyramid:base=3").value()});
        config.open = true;
        config.handleSignals = false;
        config.log = [](Severity, const std::string&) {};
        host = Host::open(std::move(config)).value();
    }
    ~WebHost() override {
        host.reset();
        std::filesystem::remove_all(data);
    }

    std::string data = testing::TempDir() + "huestep-web-" +
                       std::to_string(std::chrono::steady_clock::now().time_since_epoch().count());
    std::unique_ptr<Host> host;
};

TEST_F(WebHost, ReportsThePortThatItGot) {
    const auto web = WebEndpoint::open(*host, {});
    ASSERT_TRUE(web) << web.error().message;
    EXPECT_TRUE((*web)->address().starts_with("127.0.0.1:"));
    EXPECT_NE((*web)->address(), "127.0.0.1:0");
}

TEST_F(WebHost, AnAddressInUseIsNamedInTheSentence) {
    const auto first = WebEndpoint::open(*host, {});
    ASSERT_TRUE(first);
    const auto second = WebEndpoint::open(*host, {(*first)->address(), {}, {}});
    ASSERT_FALSE(second);
    EXPECT_NE(second.error().message.find((*first)->address()), std::string::npos);
    EXPECT_NE(second.error().message.find("in use"), std::string::npos) << second.error().message;
    EXPECT_FALSE(WebEndpoint::open(*host, {"nowhere", {}, {}}));
}

TEST_F(WebHost, StopsWithItsHost) {
    const auto web = WebEndpoint::open(*host, {});
    ASSERT_TRUE(web);
    std::thread stopper([this] {
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
        host->stop();
    });
    EXPECT_TRUE(host->run());
    stopper.join();
    EXPECT_EQ((*web)->viewers(), 0u);
}

TEST_F(WebHost, ListensOnTheFirstNumberOfANameThatCanBeBound) {
    const auto web = WebEndpoint::open(*host, {"two-numbers.test:0", {}, {}});
    ASSERT_TRUE(web) << web.error().message;
    EXPECT_TRUE((*web)->address().starts_with("127.0.0.1:")) << (*web)->address();
    HostConfig config;
    config.listen = "two-numbers.test:0";
    config.data = data + "/other";
    config.sessions.push_back({"pile", sceneFromCatalog("pyramid:base=3").value()});
    config.open = true;
    config.handleSignals = false;
    config.log = [](Severity, const std::string&) {};
    const auto other = Host::open(std::move(config));
    ASSERT_TRUE(other) << other.error().message;
    EXPECT_TRUE((*other)->address().starts_with("127.0.0.1:")) << (*other)->address();
}

/// A viewer's connection: asks for the WebSocket of session `pile`; what follows is read raw.
int viewerOf(const std::string& address) {
    const std::size_t colon = address.rfind(':');
    sockaddr_in to{};
    uv_ip4_addr(address.substr(0, colon).c_str(), std::stoi(address.substr(colon + 1)), &to);
    const int handle = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    EXPECT_EQ(::connect(handle, reinterpret_cast<const sockaddr*>(&to), sizeof to), 0);
    const timeval patience{10, 0};
    ::setsockopt(handle, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    const std::string ask =
        "GET /view?session=pile HTTP/1.1\r\nHost: " + address + "\r\nOrigin: http://" + address +
        "\r\nConnection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
        "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n"
        "Sec-WebSocket-Protocol: huestep-view\r\n\r\n";
    EXPECT_EQ(::send(handle, ask.data(), ask.size(), MSG_NOSIGNAL),
              static_cast<ssize_t>(ask.size()));
    return handle;
}

/// Reads until `count` frames of the protocol have begun; how many did.
std::size_t framesHeard(int handle, std::size_t count) {
    std::string heard;
    std::size_t frames = 0;
    std::array<char, 4096> part{};
    while (frames < count) {
        const ssize_t got = ::recv(handle, part.data(), part.size(), 0);
        if (got <= 0) return frames;
        heard.append(part.data(), static_cast<std::size_t>(got));
        frames = 0;
        const std::string magic(reinterpret_cast<const char*>(viewMagic().data()), 4);
        for (std::size_t at = heard.find(magic); at != std::string::npos;
             at = heard.find(magic, at + 1)) {
            ++frames;
        }
    }
    return frames;
}

TEST(WebHeartbeat, ViewersOfASessionThatStandsStillHearOfItNowAndThen) {
    HostConfig config;
    config.listen = "127.0.0.1:0";
    config.data = testing::TempDir() + "huestep-still-" +
                  std::to_string(std::chrono::steady_clock::now().time_since_epoch().count());
    const std::string data = config.data;
    config.sessions.push_back({"pile", sceneFromCatalog("pyramid:base=3").value()});
    config.open = true;
    config.handleSignals = false;
    config.limits.uncommittedTicks = 0;  // it waits for its disk for good
    config.log = [](Severity, const std::string&) {};
    auto host = Host::open(std::move(config)).value();
    WebConfig page;
    page.limits.heartbeatMs = 20;
    const auto web = WebEndpoint::open(*host, page);
    ASSERT_TRUE(web) << web.error().message;
    std::thread thread([&] { EXPECT_TRUE(host->run()); });
    const int viewer = viewerOf((*web)->address());
    EXPECT_EQ(framesHeard(viewer, 4), 4u);
    ::close(viewer);
    host->stop();
    thread.join();
    EXPECT_EQ(host->hub().find("pile")->tick(), 0u);
    host.reset();
    std::filesystem::remove_all(data);
}

}  // namespace
}  // namespace huestep::server
