#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <map>
#include <optional>
#include <sstream>
#include <utility>

#include "client/bot.h"

namespace huestep::client {

namespace {

constexpr std::size_t maxScriptBytes = 4u << 20;

/// The words of one line, read from left to right; the first thing wrong is kept as a sentence.
class Words {
 public:
    explicit Words(std::string_view line) {
        std::istringstream in{std::string(line.substr(0, line.find('#')))};
        for (std::string word; in >> word;) m_words.push_back(std::move(word));
    }
    [[nodiscard]] bool none() const { return m_words.empty(); }
    [[nodiscard]] std::size_t left() const { return m_words.size() - m_at; }
    [[nodiscard]] const std::string& problem() const { return m_problem; }

    std::string word(const char* what) {
        if (left() == 0) {
            wrong(std::string(what) + " is missing");
            return {};
        }
        return m_words[m_at++];
    }
    template <class Number>
    Number number(const char* what) {
        const std::string text = word(what);
        Number value{};
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        const bool whole = error == std::errc{} && end == text.data() + text.size();
        if (!whole || !std::isfinite(static_cast<double>(value))) {
            wrong(std::string(what) + " is no number in range: '" + text + "'");
        }
        return value;
    }
    Vec2 vector(const char* what) {
        const float x = number<float>(what);
        return {x, number<float>(what)};
    }
    void wrong(std::string problem) {
        if (m_problem.empty()) m_problem = std::move(problem);
    }

 private:
    std::vector<std::string> m_words;
    std::size_t m_at = 0;
    std::string m_problem;
};

BodyId readBody(Words& words, ScriptLine& line) {
    const std::string text = words.word("the body");
    line.onSelf = text == "me";
    line.onLastSpawn = text == "spawned";
    if (line.onSelf || line.onLastSpawn) return 0;
    BodyId id = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), id);
    if (error != std::errc{} || end != text.data() + text.size() || id == 0) {
        words.wrong("a body is an id from 1, 'me' or 'spawned', not '" + text + "'");
    }
    return id;
}

/// A push's point: given, or the body's centre when it is left out.
Vec2 readPoint(Words& words, ScriptLine& line) {
    line.atCenter = words.left() == 0;
    return line.atCenter ? Vec2{} : words.vector("the point");
}

ShapeDef readShape(Words& words) {
    const std::string kind = words.word("the shape");
    if (kind == "circle") return ShapeDef::circle({}, words.number<float>("the radius"));
    if (kind == "box") {
        const Vec2 half = words.vector("the half size");
        return ShapeDef::box(half.x, half.y);
    }
    words.wrong("a spawned shape is 'circle' or 'box', not '" + kind + "'");
    return {};
}

Action readSpawn(Words& words) {
    BodyDef body;
    body.type = BodyType::Dynamic;
    body.shapes.push_back(readShape(words));
    body.position = words.vector("the position");
    if (words.problem().empty()) {
        if (const Status checked = check(body, "spawn"); !checked) {
            words.wrong(checked.error().message);
        }
    }
    return Spawn{{body}, {}};
}

Action readMotor(Words& words) {
    SetMotor motor;
    motor.joint = words.number<JointId>("the joint");
    const std::string state = words.word("on or off");
    if (state != "on" && state != "off")
        words.wrong("a motor is 'on' or 'off', not '" + state + "'");
    motor.enabled = state == "on";
    motor.speed = words.number<float>("the speed");
    return motor;
}

Action readCustom(Words& words) {
    Custom custom;
    custom.kind = words.number<std::uint32_t>("the kind");
    if (words.left() > 0) custom.vector = words.vector("the vector");
    if (words.left() > 0) custom.number = words.number<std::int32_t>("the number");
    if (words.left() > 0) custom.id = words.number<std::uint32_t>("the id");
    return custom;
}

using Reader = Action (*)(Words&, ScriptLine&);

const std::map<std::string_view, Reader> readers{
    {"impulse",
     [](Words& words, ScriptLine& line) -> Action {
         const BodyId body = readBody(words, line);
         const Vec2 impulse = words.vector("the impulse");
         return ApplyImpulse{body, impulse, readPoint(words, line)};
     }},
    {"force",
     [](Words& words, ScriptLine& line) -> Action {
         const BodyId body = readBody(words, line);
         const Vec2 force = words.vector("the force");
         return ApplyForce{body, force, readPoint(words, line)};
     }},
    {"grab",
     [](Words& words, ScriptLine& line) -> Action {
         const BodyId body = readBody(words, line);
         const Vec2 point = words.vector("the point");
         return Grab{body, point, words.vector("the target")};
     }},
    {"move",
     [](Words& words, ScriptLine&) -> Action { return MoveGrab{words.vector("the target")}; }},
    {"release", [](Words&, ScriptLine&) -> Action { return Release{}; }},
    {"spawn", [](Words& words, ScriptLine&) -> Action { return readSpawn(words); }},
    {"remove",
     [](Words& words, ScriptLine& line) -> Action { return RemoveBody{readBody(words, line)}; }},
    {"motor", [](Words& words, ScriptLine&) -> Action { return readMotor(words); }},
    {"custom", [](Words& words, ScriptLine&) -> Action { return readCustom(words); }},
};

Result<ScriptLine> readLine(Words& words, std::uint64_t earliest) {
    ScriptLine line;
    line.tick = words.number<std::uint64_t>("the tick");
    const std::string name = words.word("the action");
    if (!words.problem().empty()) return Error{words.problem()};
    if (line.tick < earliest) {
        return Error{"tick " + std::to_string(line.tick) + " comes after tick " +
                     std::to_string(earliest) + "; ticks rise"};
    }
    const auto reader = readers.find(name);
    if (reader == readers.end()) {
        return Error{
            "there is no action '" + name +
            "'; there are custom, force, grab, impulse, motor, move, release, remove and spawn"};
    }
    line.action = reader->second(words, line);
    if (!words.problem().empty()) return Error{words.problem()};
    if (words.left() != 0) return Error{words.word("a word") + " is one word too many"};
    return line;
}

}  // namespace

Result<std::vector<ScriptLine>> parseScript(std::string_view text, const std::string& name) {
    std::vector<ScriptLine> out;
    std::size_t number = 0;
    while (!text.empty()) {
        ++number;
        const std::size_t end = text.find('\n');
        Words words(text.substr(0, end));
        text = end == std::string_view::npos ? std::string_view{} : text.substr(end + 1);
        if (words.none()) continue;
        Result<ScriptLine> line = readLine(words, out.empty() ? 0 : out.back().tick);
        if (!line) {
            return Error{name + ":" + std::to_string(number) + ": " + line.error().message};
        }
        out.push_back(std::move(*line));
    }
    return out;
}

Result<std::unique_ptr<Bot>> readScript(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) return Error{path + ": cannot be opened"};
    std::string text;
    char piece[4096];
    while (file.read(piece, sizeof piece) || file.gcount() > 0) {
        text.append(piece, static_cast<std::size_t>(file.gcount()));
        if (text.size() > maxScriptBytes) {
            return Error{path + ": a script has at most 4 MiB"};
        }
    }
    if (file.bad()) return Error{path + ": cannot be read"};
    Result<std::vector<ScriptLine>> lines = parseScript(text, path);
    if (!lines) return lines.error();
    return makeScriptBot(std::move(*lines));
}

}  // namespace huestep::client
