// The web endpoint without a browser: its answers, what waits for a viewer, and its life in a host.
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <thread>

#include "core/scene/catalog.h"
#include "server/web_assets.h"
#include "server/web_endpoint.h"
#include "server/web_listener.h"
#include "server/web_route.h"
#include "server/web_viewer.h"

namespace huestep::server {
namespace {

const std::vector<WebSession> two{{"arena", 60, 12, 3}, {"pile", 0, 1, 0}};

std::string visitor(const char* number) {
    sockaddr_storage storage{};
    if (uv_ip4_addr(number, 1, reinterpret_cast<sockaddr_in*>(&storage)) != 0) {
        EXPECT_EQ(uv_ip6_addr(number, 1, reinterpret_cast<sockaddr_in6*>(&storage)), 0) << number;
    }
    return visitorOf(storage);
}

TEST(WebListener, OneVisitorIsAnIpv4NumberOrTheHalfOfAnIpv6Number) {
    EXPECT_EQ(visitor("192.0.2.7"), "192.0.2.7");
    EXPECT_EQ(visitor("2001:db8:1:2:3:4:5:6"), "2001:db8:1:2::");
    EXPECT_EQ(visitor("2001:db8:1:2:9:9:9:9"), visitor("2001:db8:1:2::1"));
    EXPECT_NE(visitor("2001:db8:1:3::1"), visitor("2001:db8:1:2::1"));
    // As a listener of both families sees IPv4.
    EXPECT_EQ(visitor("::ffff:192.0.2.7"), "::ffff:192.0.2.7");
    EXPECT_NE(visitor("::ffff:192.0.2.7"), visitor("::ffff:192.0.2.8"));
}

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

}  // namespace
}  // namespace huestep::server
