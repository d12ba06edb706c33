#include "core/scene/catalog.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <optional>

#include "core/scene/scenes.h"

namespace huestep {

namespace {

/// What every scene takes, after its own.
constexpr std::array<SceneParameter, 4> common{{
    {"seed", 0, 0, 1e6, "unless 0, bodies start up to 1 mm and 1 mrad aside, drawn from it"},
    {"turn", 0, -180, 180, "degrees that all is turned by, gravity too", false},
    {"far", 0, 0, 500, "km from the origin", false},
    {"hz", 60, 10, 10000, "ticks a second; a host goes by ticks", false},
}};

std::vector<CatalogEntry> makeCatalog() {
    using namespace scenes;
    const std::string_view boxSide = "boxes in the lowest row";
    return {
        {"arm",
         "a disc that goes round on a 5 m arm without gravity: radius and energy must stay",
         300,
         {{"speed", 10, 0.1, 100, "rad/s", false}},
         arm},
        {"ball",
         "a ball game for two teams, seen from above, by the rules of that name; players have "
         "bodies",
         3600,
         {{"length", 30, 10, 200, "m from goal to goal", false},
          {"width", 18, 6, 100, "m", false},
          {"goals", 5, 1, 1000, "that win a game"},
          {"seconds", 180, 1, 3600, "that a game lasts", false},
          {"dice", 1, 0, 1e6, "seed of the rules' dice"}},
         ball},
        {"ballistic",
         "a disc in free flight: after 1 s it must be on its parabola",
         60,
         {{"vx", 3, -100, 100, "m/s at the start, to the right", false},
          {"vy", 4, -100, 100, "m/s at the start, upwards", false}},
         ballistic},
        {"bounce",
         "a disc that drops on the ground and bounces: apex and energy",
         120,
         {{"restitution", 0.8, 0, 1, "of the disc and the ground", false},
          {"height", 2, 0.1, 20, "m that it falls", false}},
         bounce},
        {"building",
         "the sandbox by the rules of that name: players put pieces there, within a budget",
         3600,
         {{"budget", 12, 1, 32, "pieces that a player may have at a time"},
          {"pause", 0.25, 0, 60, "s from one piece of a player to its next", false},
          {"dice", 1, 0, 1e6, "seed of the rules' dice"}},
         building},
        {"chain",
         "10 links of 1 kg and a heavy ball: joint error at high mass ratio",
         600,
         {{"ratio", 100, 1, 1e6, "mass of the ball, in links (kg)", false},
          {"angle", 0, 0, 170, "degrees from hanging at the start; 90 is horizontal", false}},
         chain},
        {"compounds",
         "bodies of two triangles that heap up in a trough: contacts of many shapes a body",
         500,
         {{"columns", 20, 1, 38, "bodies beside each other"},
          {"rows", 150, 1, 1000, "bodies above each other"}},
         compounds},
        {"double_pendulum",
         "two discs on 1 m arms, released horizontally: against its differential equation",
         60,
         {},
         doublePendulum},
        {"hinges",
         "leaning columns of hinged boxes that topple, come to rest and sleep",
         600,
         {{"columns", 4, 1, 40, "columns"}, {"rows", 12, 1, 60, "boxes in a column"}},
         hinges},
        {"joint_grid",
         "a net of discs on revolute joints, hung from 7 of them: joints alone",
         500,
         {{"n", 100, 4, 300, "discs along a side"}, {"gravity", 1, 0.1, 10, "of 10 m/s²", false}},
         jointGrid},
        {"joints",
         "welds and slides with every part: rigid, springs, stops, motors",
         600,
         {},
         joints},
        {"junkyard",
         "scrap of five corners in a trough, and a pusher that goes to and fro through it",
         800,
         {{"columns", 200, 1, 200, "pieces beside each other"},
          {"rows", 40, 1, 400, "pieces above each other"}},
         junkyard,
         junkyardHost},
        {"many_pyramids",
         "hundreds of small pyramids: many islands of equal size",
         200,
         {{"rows", 20, 1, 40, "rows of pyramids"},
          {"columns", 20, 1, 40, "pyramids in a row"},
          {"base", 10, 1, 30, boxSide}},
         manyPyramids},
        {"mixed", "every shape, joint, filter and kind of body in one small world", 600, {}, mixed},
        {"pendulum",
         "a disc of radius 0.1 m on a 1 m arm: period and energy",
         600,
         {{"angle", 90, 1, 170, "degrees from hanging at the start", false}},
         pendulum},
        {"pyramid",
         "one large pyramid: one island, contacts alone",
         500,
         {{"base", 100, 1, 450, boxSide}},
         pyramid},
        {"rain",
         "ragdolls that come in groups, fall and go again: spawns, removals, soft joints",
         1000,
         {{"floors", 5, 1, 5, "floors, each with its own rain"},
          {"columns", 40, 1, 40, "groups beside each other"},
          {"group", 5, 1, 5, "ragdolls in a group"},
          {"period", 8, 1, 600, "ticks from a column of groups to the next"}},
         rain,
         rainHost},
        {"ramp",
         "a box or a disc on a slope, at rest at the start: sliding, sticking, rolling",
         120,
         {{"angle", 20, 0, 60, "degrees, downwards to the right", false},
          {"friction", 0.3, 0, 10, "of the body and the slope", false},
          {"disc", 0, 0, 1, "1: a disc of radius 0.5 m instead of a unit box"}},
         ramp},
        {"sandbox",
         "a walled arena to play in: piles, see-saw, paddle, rope and swing; players have bodies",
         3600,
         {},
         sandbox},
        {"slide",
         "a box or a disc pushed along level ground: stopping distance, sliding to rolling",
         120,
         {{"speed", 5, 0, 20, "m/s at the start, to the right, without spin", false},
          {"friction", 0.4, 0, 10, "of the body and the ground", false},
          {"disc", 0, 0, 1, "1: a disc of radius 0.5 m instead of a unit box"}},
         slide},
        {"small",
         "three columns of boxes and a disc dropped on them: the cost of little work",
         600,
         {{"n", 40, 1, 3000, "boxes"}, {"sleep", 1, 0, 1, "1: they fall asleep at rest"}},
         small},
        {"smash",
         "a heavy box at 40 m/s into a wall of boxes that sleep: waking, one island that grows",
         300,
         {{"columns", 120, 1, 300, "boxes beside each other"},
          {"rows", 80, 1, 300, "boxes above each other"}},
         smash},
        {"spinner",
         "a bar that whirls loose bodies around a round room: blows, all shapes, a chain",
         500,
         {{"bodies", 6076, 1, 11000, "capsules, discs and boxes in turn"}},
         spinner},
        {"stack",
         "one tower of unit boxes with a zig-zag of 1 cm: it must stand",
         1200,
         {{"n", 20, 1, 200, "boxes"}},
         stack},
        {"terrain", "chains: a wavy room, a turning island, a conveyor", 600, {}, terrain},
        {"tumbler",
         "boxes in a turning drum: contacts that come and go all the time",
         750,
         {{"count", 45, 1, 100, "boxes along a side of the block"}},
         tumbler},
        {"washer",
         "small boxes in a turning ring with paddles: a kinematic hub, contacts that change",
         500,
         {{"count", 90, 1, 100, "boxes along a side of the block"}},
         washer},
    };
}

std::string numberText(double value) {
    std::array<char, 32> buffer{};
    const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
    return {buffer.data(), end};
}

/// What a person typed, cut to a length that fits into a sentence.
std::string quoted(std::string_view text) {
    std::string result;
    result += '\'';
    result += text.substr(0, 40);
    result += text.size() > 40 ? "...'" : "'";
    return result;
}

std::string sceneNames() {
    std::string names;
    for (const CatalogEntry& entry : sceneCatalog()) {
        if (!names.empty()) names += ", ";
        names += entry.name;
    }
    return names;
}

std::string parameterNames(const CatalogEntry& entry) {
    std::string names = "it has ";
    for (const SceneParameter& parameter : entry.parameters) {
        names += parameter.name;
        names += ", ";
    }
    names += entry.parameters.empty() ? "those of every scene:" : "and as every scene has";
    for (const SceneParameter& parameter : common) {
        names += &parameter == common.data() ? " " : ", ";
        names += parameter.name;
    }
    return names;
}

/// The entry's own parameters, then the common ones.
std::vector<SceneParameter> allParameters(const CatalogEntry& entry) {
    std::vector<SceneParameter> all = entry.parameters;
    all.insert(all.end(), common.begin(), common.end());
    return all;
}

/// The number that is all of the text, correctly rounded and without locale.
std::optional<double> numberOf(std::string_view text) {
#if defined(__wasm__)
    // libc++ 19 has no from_chars of reals. The C library there knows one locale; what it takes
    // beyond from_chars starts with a space or a plus, or has an x.
    const bool more = text.find_first_of(" \t\n\v\f\r+") == 0;
    if (text.empty() || more || text.find_first_of("xX") != text.npos) return std::nullopt;
    const std::string ended(text);
    char* end = nullptr;
    const double value = std::strtod(ended.c_str(), &end);
    if (end != ended.c_str() + ended.size()) return std::nullopt;
    return value;
#else
    double value = 0.0;
    const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
    if (read.ec != std::errc() || read.ptr != text.data() + text.size()) return std::nullopt;
    return value;
#endif
}

/// Reads one `parameter=value` into its place in `values`.
Status readParameter(const CatalogEntry& entry, std::string_view text, std::vector<double>& values,
                     std::vector<bool>& given) {
    const std::string scene(entry.name);
    const std::vector<SceneParameter> parameters = allParameters(entry);
    const std::size_t equals = text.find('=');
    const std::string_view name = text.substr(0, equals);
    std::size_t place = 0;
    while (place < parameters.size() && parameters[place].name != name) ++place;
    if (place == parameters.size()) {
        return Error{scene + " has no parameter " + quoted(name) + "; " + parameterNames(entry)};
    }
    const SceneParameter& parameter = parameters[place];
    const std::string path = scene + ": " + std::string(parameter.name);
    if (equals == std::string_view::npos) {
        return Error{path + " needs a value, as in " + std::string(parameter.name) + "=" +
                     numberText(parameter.standard)};
    }
    if (given[place]) return Error{path + " is given twice"};
    const std::string_view digits = text.substr(equals + 1);
    const std::optional<double> number = numberOf(digits);
    if (!number) return Error{path + ": " + quoted(digits) + " is not a number"};
    const double value = *number;
    const bool inRange = value >= parameter.low && value <= parameter.high;
    if (!inRange || (parameter.whole && value != std::floor(value))) {
        return Error{path + " must be a " + (parameter.whole ? "whole " : "") + "number from " +
                     numberText(parameter.low) + " to " + numberText(parameter.high) + ", is " +
                     numberText(value)};
    }
    values[place] = value;
    given[place] = true;
    return Done{};
}

}  // namespace

std::span<const CatalogEntry> sceneCatalog() {
    static const std::vector<CatalogEntry> catalog = [] {
        std::vector<CatalogEntry> all = makeCatalog();
        for (CatalogEntry& entry : scenes::stabilityCatalog()) all.push_back(std::move(entry));
        std::sort(all.begin(), all.end(),
                  [](const CatalogEntry& a, const CatalogEntry& b) { return a.name < b.name; });
        return all;
    }();
    return catalog;
}

std::span<const SceneParameter> commonParameters() {
    return common;
}

const CatalogEntry* findInCatalog(std::string_view text) {
    const std::string_view name = text.substr(0, text.find(':'));
    for (const CatalogEntry& entry : sceneCatalog()) {
        if (entry.name == name) return &entry;
    }
    return nullptr;
}

namespace {

/// An entry of the catalogue, a value for each of its parameters, and what the common ones say.
struct Choice {
    const CatalogEntry* entry = nullptr;
    std::vector<double> values;
    Placement placement;
    float stepSeconds = 0.0f;  ///< s; 0: the scene's own
};

/// Cuts the values of the common parameters off the others.
Choice choiceOf(const CatalogEntry& entry, std::vector<double> values,
                const std::vector<bool>& given) {
    const std::size_t own = entry.parameters.size();
    Choice choice{&entry, {}, {}, 0.0f};
    choice.placement = {static_cast<std::uint64_t>(values[own]), values[own + 1], values[own + 2]};
    if (given[own + 3]) choice.stepSeconds = static_cast<float>(1.0 / values[own + 3]);
    values.resize(own);
    choice.values = std::move(values);
    return choice;
}

Result<Choice> choose(std::string_view text) {
    const CatalogEntry* entry = findInCatalog(text);
    const std::size_t colon = text.find(':');
    if (entry == nullptr) {
        return Error{"there is no scene " + quoted(text.substr(0, colon)) + "; there are " +
                     sceneNames()};
    }
    if (text.size() > caps::maxSceneName) {
        return Error{"a scene's name and parameters take at most 256 characters"};
    }
    std::vector<double> values;
    for (const SceneParameter& parameter : allParameters(*entry)) {
        values.push_back(parameter.standard);
    }
    std::vector<bool> given(values.size(), false);
    std::string_view rest = colon == std::string_view::npos ? "" : text.substr(colon + 1);
    if (colon != std::string_view::npos && rest.empty()) {
        return Error{std::string(entry->name) + ": nothing stands after the colon; " +
                     parameterNames(*entry)};
    }
    while (!rest.empty()) {
        const std::size_t comma = rest.find(',');
        const Status read = readParameter(*entry, rest.substr(0, comma), values, given);
        if (!read) return read.error();
        if (comma == std::string_view::npos) break;
        rest = rest.substr(comma + 1);
        if (rest.empty()) {
            return Error{std::string(entry->name) + ": nothing stands after the last comma"};
        }
    }
    return choiceOf(*entry, std::move(values), given);
}

}  // namespace

Result<Scene> sceneFromCatalog(std::string_view text) {
    const Result<Choice> choice = choose(text);
    if (!choice) return choice.error();
    Scene scene = choice->entry->build(choice->values);
    if (choice->stepSeconds > 0.0f) scene.stepSeconds = choice->stepSeconds;
    place(scene, choice->placement);
    scene.name = text;
    return scene;
}

Result<Script> scriptFromCatalog(std::string_view text) {
    const Result<Choice> choice = choose(text);
    if (!choice) return choice.error();
    return Script(choice->entry->script, choice->values, choice->placement);
}

Result<Placement> placementFromCatalog(std::string_view text) {
    const Result<Choice> choice = choose(text);
    if (!choice) return choice.error();
    return choice->placement;
}

}  // namespace huestep
