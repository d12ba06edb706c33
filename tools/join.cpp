/// `huestep join`: a client without a screen.
#include <unistd.h>

#include <cstdio>
#include <memory>
#include <optional>
#include <random>

#include "client/player.h"
#include "protocol/fingerprint.h"
#include "tools/clock.h"
#include "tools/command.h"
#include "tools/interrupt.h"
#include "tools/text.h"
#include "tools/ticket_text.h"
#include "tools/whole_number.h"

namespace huestep::tools {
namespace {

struct Options {
    std::string address;
    std::string session;
    std::string bot = "wander";
    std::uint64_t ticks = 0;
    bool predict = false;
    std::optional<std::uint32_t> inputDelay;
    std::string guess = "none";
    std::uint32_t lagMs = 0;
    std::uint32_t jitterMs = 0;
    std::string ticket;
    bool tls = false;
    std::string authorities;
    bool json = false;
};

// Pushes of others that are expected to go on: about half of what a bot's take.
constexpr std::uint32_t guessedTicks = 6;

Result<std::unique_ptr<client::Bot>> makeBot(const std::string& text) {
    if (text == "idle") return client::makeIdleBot();
    if (text == "wander" || text == "play") {
        const std::uint64_t seed = std::random_device{}();
        std::fprintf(stderr, "%s: seed %llu\n", text.c_str(),
                     static_cast<unsigned long long>(seed));
        return text == "play" ? client::makeGameBot(seed) : client::makeWanderBot(seed);
    }
    const std::string prefix = "script:";
    if (text.starts_with(prefix)) return client::readScript(text.substr(prefix.size()));
    return Error{"--bot: '" + text + "' is none of wander, play, idle and script:FILE"};
}

Result<std::optional<client::PredictionRules>> rulesOf(const Options& options) {
    if (options.guess != "none" && options.guess != "pushes")
        return Error{"--guess: '" + options.guess + "' is neither none nor pushes"};
    const bool meant = options.inputDelay || options.guess != "none";
    if (!options.predict && meant)
        return Error{"--input-delay and --guess are for --predict alone"};
    if (!options.predict) return std::optional<client::PredictionRules>();
    client::PredictionRules rules;
    rules.pacing.inputDelay = options.inputDelay;
    if (options.guess == "pushes") rules.guess = client::pushesGoOn(guessedTicks);
    rules.clock = nanoseconds;
    return std::optional(std::move(rules));
}

client::LagRules lagOf(const Options& options) {
    constexpr client::Instant millisecond = 1'000'000;
    // Half on either way.
    return {options.lagMs * millisecond / 2, options.jitterMs * millisecond / 2, 1};
}

/// Null: none is spoken.
Result<std::shared_ptr<const protocol::TlsContext>> tlsOf(const Options& options) {
    if (!options.tls && !options.authorities.empty()) return Error{"--tls-ca is for --tls alone"};
    if (!options.tls) return std::shared_ptr<const protocol::TlsContext>();
    auto context = protocol::TlsContext::forClient(options.authorities);
    if (!context) return Error{"--tls-ca: " + context.error().message};
    return std::shared_ptr<const protocol::TlsContext>(
        std::make_shared<protocol::TlsContext>(std::move(context).value()));
}

double perSecond(std::uint64_t amount, double seconds) {
    return seconds > 0.0 ? static_cast<double>(amount) / seconds : 0.0;
}

void showProgress(const client::Statistics& now) {
    std::fprintf(stderr, "\rtick %llu, %llu hashes compared, mismatches: %llu\033[K",
                 static_cast<unsigned long long>(now.tick),
                 static_cast<unsigned long long>(now.hashesCompared),
                 static_cast<unsigned long long>(now.mismatches));
}

double mean(double sum, std::uint64_t count) {
    return count == 0 ? 0.0 : sum / static_cast<double>(count);
}

Json asJson(const client::PredictionFigures& p) {
    return {{"lead_ticks", p.lead},
            {"input_delay_ticks", p.inputDelay},
            {"round_trip_s", p.roundTrip},
            {"jitter_s", p.jitter},
            {"ticks_predicted", p.predicted},
            {"rollbacks", p.rollbacks},
            {"depth_ticks",
             {{"mean", mean(static_cast<double>(p.undone), p.rollbacks)}, {"max", p.deepest}}},
            {"ticks_stepped_again", p.again},
            {"rollback_ms",
             {{"sum", 1e-6 * static_cast<double>(p.nanoseconds)},
              {"mean", 1e-6 * mean(static_cast<double>(p.nanoseconds), p.rollbacks)},
              {"max", 1e-6 * static_cast<double>(p.nanosecondsMost)}}},
            {"error_m", {{"mean", mean(p.errorSum, p.rollbacks)}, {"max", p.errorMost}}},
            {"commands_late", p.late}};
}

void printText(const client::PredictionFigures& p) {
    const auto n = [](std::uint64_t value) { return static_cast<unsigned long long>(value); };
    std::printf("prediction   %u ticks ahead, input delay %u; round trip %s ms, jitter %s ms\n",
                p.lead, p.inputDelay, number(1e3 * p.roundTrip).c_str(),
                number(1e3 * p.jitter).c_str());
    std::printf(
        "rollbacks    %llu of %llu ticks predicted; depth mean %s, max %u; %llu ticks stepped "
        "again\n",
        n(p.rollbacks), n(p.predicted),
        number(mean(static_cast<double>(p.undone), p.rollbacks)).c_str(), p.deepest, n(p.again));
    const double nanosecondsMean = mean(static_cast<double>(p.nanoseconds), p.rollbacks);
    std::printf("             %s ms in all, mean %s ms, max %s ms each\n",
                number(1e-6 * static_cast<double>(p.nanoseconds)).c_str(),
                number(1e-6 * nanosecondsMean).c_str(),
                number(1e-6 * static_cast<double>(p.nanosecondsMost)).c_str());
    std::printf(
        "             the body furthest off by %s m in the mean, %s m at most; %llu own "
        "commands late\n",
        number(mean(p.errorSum, p.rollbacks)).c_str(), number(p.errorMost).c_str(), n(p.late));
}

Json asJson(const Options& options, const client::Statistics& s, double seconds) {
    Json json = {{"address", options.address},
                 {"session", options.session},
                 {"player", s.player},
                 {"seconds", seconds},
                 {"tick", s.tick},
                 {"hash", hex(s.root)},
                 {"ticks", s.ticks},
                 {"hashes_compared", s.hashesCompared},
                 {"mismatches", s.mismatches},
                 {"corrections", s.corrections},
                 {"snapshots", s.snapshots},
                 {"connections", s.connections},
                 {"resumes", s.resumes},
                 {"rolled_back_ticks", s.rolledBack},
                 {"committed_ticks_lost", s.committedLost},
                 {"commands",
                  {{"sent", s.commandsSent},
                   {"resent", s.commandsResent},
                   {"seen", s.commandsSeen},
                   {"rejected", s.commandsRejected}}},
                 {"bytes", {{"in", s.bytesIn}, {"out", s.bytesOut}}},
                 {"bytes_a_second",
                  {{"in", perSecond(s.bytesIn, seconds)}, {"out", perSecond(s.bytesOut, seconds)}}},
                 {"latency_s", {{"median", s.latencyMedian}, {"p99", s.latencyP99}}}};
    if (s.prediction) json["prediction"] = asJson(*s.prediction);
    if (!s.score.empty()) json["score"] = s.score;
    if (s.lastDesync)
        json["last_desync"] = {{"tick", s.lastDesync->tick},
                               {"body", s.lastDesync->body},
                               {"field", s.lastDesync->field},
                               {"here", s.lastDesync->here},
                               {"there", s.lastDesync->there}};
    return json;
}

void printText(const client::Statistics& s, double seconds) {
    const auto n = [](std::uint64_t value) { return static_cast<unsigned long long>(value); };
    std::printf("player       %u, tick %llu, hash %s\n", s.player, n(s.tick), hex(s.root).c_str());
    if (!s.score.empty()) std::printf("score        %s\n", s.score.c_str());
    std::printf("latency      median %s ms, p99 %s ms\n", number(1e3 * s.latencyMedian).c_str(),
                number(1e3 * s.latencyP99).c_str());
    std::printf("corrections  %llu; snapshots %llu, resumes %llu\n", n(s.corrections),
                n(s.snapshots), n(s.resumes));
    std::printf("commands     %llu sent, %llu seen, %llu rejected\n", n(s.commandsSent),
                n(s.commandsSeen), n(s.commandsRejected));
    if (s.prediction) printText(*s.prediction);
    std::printf("bytes        in %.0f a second, out %.0f a second\n", perSecond(s.bytesIn, seconds),
                perSecond(s.bytesOut, seconds));
    if (s.lastDesync)
        std::printf("desync       tick %llu body %u %s: %s here, %s there\n", n(s.lastDesync->tick),
                    s.lastDesync->body, s.lastDesync->field.c_str(), s.lastDesync->here.c_str(),
                    s.lastDesync->there.c_str());
    std::printf(
        "ticks: %llu, hashes compared: %llu, mismatches: %llu, bytes in: %llu, bytes out: "
        "%llu, seconds: %.2f\n",
        n(s.ticks), n(s.hashesCompared), n(s.mismatches), n(s.bytesIn), n(s.bytesOut), seconds);
}

Answer join(const Options& options) {
    Result<std::optional<client::PredictionRules>> rules = rulesOf(options);
    if (!rules) return rules.error();
    Result<std::unique_ptr<client::Bot>> bot = makeBot(options.bot);
    if (!bot) return bot.error();
    Result<std::vector<std::byte>> ticket = readTicket(options.ticket);
    if (!ticket) return Error{"--ticket: " + ticket.error().message};
    auto tls = tlsOf(options);
    if (!tls) return tls.error();
    const Result<protocol::Fingerprint> fingerprint = protocol::selfTest();
    if (!fingerprint) return fingerprint.error();

    const bool terminal = isatty(STDERR_FILENO) != 0;
    client::PlayerConfig config;
    config.address = options.address;
    config.session = options.session;
    config.fingerprint = *fingerprint;
    config.ticket = std::move(*ticket);
    config.tls = std::move(*tls);
    config.bot = std::move(bot).value();
    config.ticks = options.ticks;
    config.prediction = std::move(*rules);
    config.lag = lagOf(options);
    config.stop = &interruptFlag();  // signals that come before the client has handlers of its own
    if (terminal) config.onProgress = showProgress;
    config.onNotice = [terminal](const std::string& sentence) {
        std::fprintf(stderr, "%s%s\n", terminal ? "\r\033[K" : "", sentence.c_str());
    };
    std::optional<client::Statistics> last;
    config.onEnd = [&last](const client::Statistics& statistics) { last = statistics; };
    const std::uint64_t begin = nanoseconds();
    const Result<client::Statistics> played = client::play(std::move(config));
    const double seconds = static_cast<double>(nanoseconds() - begin) * 1e-9;
    if (terminal) std::fputs("\r\033[K", stderr);
    if (last && options.json) {
        Json document = asJson(options, *last, seconds);
        if (!played) document["failure"] = played.error().message;
        print(document);
    } else if (last) {
        printText(*last, seconds);
    }
    // A server that is gone does not take with it what was verified before.
    if (!played) return played.error();
    return played->mismatches == 0 && played->committedLost == 0 ? Exit::Done : Exit::Differs;
}

}  // namespace

void addJoin(Menu& menu) {
    const auto o = std::make_shared<Options>();
    CLI::App* sub = menu.add("join", "A client without a screen: plays and verifies every hash.",
                             "huestep join 127.0.0.1:7777 --session play --bot wander --ticks 600",
                             [o] { return join(*o); });
    sub->add_option("HOST:PORT", o->address, "Where the server listens")->required();
    sub->add_option("--session", o->session, "Which session to play")->required();
    sub->add_option(
        "--bot", o->bot,
        "wander, play (the game of the session's rules), idle or script:FILE (default: wander)");
    sub->add_option("--ticks", o->ticks, "Leave after so many ticks (default: at Ctrl-C)")
        ->transform(wholeNumber(1, 1'000'000'000));
    sub->add_flag("--predict", o->predict,
                  "Run ahead of the server by the round trip; tells what that took");
    sub->add_option("--input-delay", o->inputDelay,
                    "With --predict: ticks from an input to its tick (default: as the server says)")
        ->transform(wholeNumber(0, 60));
    sub->add_option("--guess", o->guess,
                    "With --predict: what others do meanwhile, none or pushes: whoever pushed goes "
                    "on (default: none)");
    sub->add_option("--lag", o->lagMs,
                    "Make the round trip so many ms longer, to try what a network would do")
        ->transform(wholeNumber(0, 10'000));
    sub->add_option("--jitter", o->jitterMs, "And by up to so many ms more, as it comes")
        ->transform(wholeNumber(0, 10'000));
    sub->add_flag("--tls", o->tls, "Speak TLS 1.3; the server's certificate must bear HOST");
    sub->add_option("--tls-ca", o->authorities,
                    "With --tls: PEM file of the certificates to trust (default: the system's)");
    sub->add_option("--ticket", o->ticket,
                    "File with a ticket, where the server asks for one; -: standard input");
    sub->add_flag("--json", o->json, "Print one JSON document");
}

}  // namespace huestep::tools
