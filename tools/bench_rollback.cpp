// `huestep bench --rollback`: what it costs to go back and step again.
#include <algorithm>
#include <array>
#include <cstdio>
#include <functional>
#include <limits>
#include <utility>

#include "core/scene/catalog.h"
#include "core/world/world.h"
#include "tools/bench_modes.h"
#include "tools/clock.h"
#include "tools/interrupt.h"
#include "tools/machine.h"
#include "tools/progress.h"
#include "tools/text.h"

namespace huestep::tools {
namespace {

constexpr std::size_t ticksBack = 8;
constexpr int settleTicks = 120;

struct Case {
    std::string name;
    Scene scene;
};

/// Boxes side by side and on one another between two walls: nearly four contacts a body.
Scene pileOf(std::uint32_t columns, std::uint32_t rows) {
    Scene scene;
    scene.sleep = false;
    BodyDef ground;
    ground.position = {0.0f, -1.0f};
    const float half = 0.5f * static_cast<float>(columns);
    const float height = 0.5f * static_cast<float>(rows);
    ground.shapes = {ShapeDef::box(100.0f, 1.0f),
                     ShapeDef::box(1.0f, height, {-half - 1.0f, height + 1.0f}),
                     ShapeDef::box(1.0f, height, {half + 1.0f, height + 1.0f})};
    scene.bodies.push_back(ground);
    BodyDef box;
    box.type = BodyType::Dynamic;
    box.shapes = {ShapeDef::box(0.5f, 0.5f)};
    for (std::uint32_t column = 0; column < columns; ++column)
        for (std::uint32_t row = 0; row < rows; ++row) {
            box.position = {static_cast<float>(column) + 0.5f - half,
                            static_cast<float>(row) + 0.5f};
            scene.bodies.push_back(box);
        }
    return scene;
}

struct Measured {
    std::string name;
    std::size_t bodies = 0;
    std::uint32_t contacts = 0;
    std::uint64_t hash = 0;  // full root at the end of the ticks that are stepped again
    double save = 0, restore = 0, step = 0, rollback = 0;  // ns, least of the repeats
    double motionRoot = 0, fullRoot = 0, gather = 0;       // ns a body
    std::size_t snapshot = 0, definitions = 0;             // bytes
    std::size_t delta = 0;                                 // bytes, against eight ticks before
};

double timed(const std::function<void()>& f) {
    const std::uint64_t begin = nanoseconds();
    f();
    return static_cast<double>(nanoseconds() - begin);
}

template <class T>
void keepLeast(T& least, T value) {
    least = std::min(least, value);
}

std::size_t definitionBytes(const World& world) {
    return world.bodies().size() * sizeof(BodyInfo) + world.shapes().size() * sizeof(ShapeInfo) +
           world.joints().size() * sizeof(JointInfo);
}

/// The ticks that will be stepped again: their full roots as they were the first time.
struct Truth {
    std::array<std::uint64_t, ticksBack> roots{};
    std::array<Checkpoint, ticksBack> after;
};

/// A few ticks in which the last body was pushed though it was not: what a wrong prediction leaves.
void goWrong(World& world) {
    const BodyId body = world.bodies().back().id;
    const Command push{0, world.tick() + 1,
                       ApplyImpulse{body, {1.0f, 1.0f}, world.motions().back().position}};
    world.step(std::vector<Command>{push});
    for (std::size_t i = 1; i < ticksBack; ++i) world.step({});
}

Result<Measured> measure(const Case& what, int repeats, Progress& progress) {
    Result<World> made = World::create(what.scene);
    if (!made) return made.error();
    World& world = *made;
    for (int tick = 0; tick < settleTicks && !interrupted(); ++tick) {
        world.step({});
        progress.advance();
    }
    Measured m;
    m.name = what.name;
    m.bodies = world.bodies().size();
    m.contacts = world.report().contacts;
    m.snapshot = world.save().size();
    m.definitions = definitionBytes(world);
    m.save = m.restore = m.step = m.rollback = m.motionRoot = m.fullRoot = m.gather =
        std::numeric_limits<double>::max();

    const World before = world;
    Checkpoint start;
    world.checkpoint(start);
    Truth truth;
    const auto perBody = static_cast<double>(m.bodies);
    for (std::size_t i = 0; i < ticksBack; ++i) {
        keepLeast(m.step, timed([&] { world.step({}); }));
        keepLeast(m.gather, timed([&] { truth.roots[i] = world.fullRoot(); }) / perBody);
        world.checkpoint(truth.after[i]);
    }
    m.hash = truth.roots.back();
    m.delta = world.saveDelta(before).size();
    for (int repeat = 0; repeat < repeats && !interrupted(); ++repeat) {
        goWrong(world);
        keepLeast(m.rollback, timed([&] {
                      world.restore(start);
                      for (Checkpoint& after : truth.after) {
                          world.step({});
                          world.checkpoint(after);
                      }
                  }));
        bool same = world.fullRoot() == m.hash;
        for (std::size_t i = 0; i < ticksBack; ++i) {
            keepLeast(m.restore, timed([&] { world.restore(truth.after[i]); }));
            keepLeast(m.gather,
                      timed([&] { same = world.fullRoot() == truth.roots[i] && same; }) / perBody);
            keepLeast(m.fullRoot, timed([&] { static_cast<void>(world.fullRoot()); }) / perBody);
            keepLeast(m.motionRoot,
                      timed([&] { static_cast<void>(world.motionRoot()); }) / perBody);
        }
        if (!same)
            return Error{what.name + ": ticks that were stepped again differ from the first time"};
        keepLeast(m.step, timed([&] { world.step({}); }));
        Checkpoint& reused = truth.after[static_cast<std::size_t>(repeat) % ticksBack];
        keepLeast(m.save, timed([&] { world.checkpoint(reused); }));
        world.restore(start);
        progress.advance();
    }
    return m;
}

Json asJson(const Measured& m) {
    return {{"scene", m.name},
            {"bodies", m.bodies},
            {"contacts", m.contacts},
            {"hash", hex(m.hash)},
            {"same_hash", true},
            {"checkpoint_us", m.save / 1e3},
            {"restore_us", m.restore / 1e3},
            {"step_us", m.step / 1e3},
            {"rollback_8_ms", m.rollback / 1e6},
            {"snapshot_bytes", m.snapshot},
            {"definition_bytes", m.definitions},
            {"delta_of_8_ticks_bytes", m.delta},
            {"motion_root_ns_a_body", m.motionRoot},
            {"full_root_ns_a_body", m.fullRoot},
            {"full_root_after_a_step_ns_a_body", m.gather}};
}

void printTable(const std::vector<Measured>& rows) {
    std::printf("%s; one thread\n", originLine().c_str());
    Table table({"scene", "bodies", "contacts", "save, µs", "restore, µs", "step, µs",
                 "8 ticks, ms", "snapshot, B", "less definitions", "delta, B", "motion root",
                 "full root", "with gathering", "hash"});
    for (const Measured& m : rows)
        table.add({m.name, std::to_string(m.bodies), std::to_string(m.contacts),
                   number(m.save / 1e3), number(m.restore / 1e3), number(m.step / 1e3),
                   number(m.rollback / 1e6), std::to_string(m.snapshot),
                   std::to_string(m.snapshot - m.definitions), std::to_string(m.delta),
                   number(m.motionRoot), number(m.fullRoot), number(m.gather), hex(m.hash)});
    table.print();
    std::printf(
        "8 ticks: a restore and 8 steps, each followed by a save, after as many wrong ones. Roots "
        "in ns a body;\nwith gathering: the first after a step, which brings the contacts "
        "together.\n");
}

}  // namespace

Answer benchRollback(int repeats, bool json) {
    std::vector<Case> cases;
    for (const char* name : {"pyramid:base=13", "pyramid:base=99"}) {
        Result<Scene> scene = sceneFromCatalog(name);
        if (!scene) return scene.error();
        cases.push_back({name, std::move(*scene)});
    }
    cases.insert(cases.begin() + 1, {"pile of 30 x 30", pileOf(30, 30)});
    repeats *= 10;  // each takes a few milliseconds
    Progress progress("rollback", cases.size() * static_cast<std::size_t>(settleTicks + repeats));
    std::vector<Measured> rows;
    for (const Case& one : cases) {
        Result<Measured> row = measure(one, repeats, progress);
        if (interrupted()) break;
        if (!row) {
            progress.clear();
            std::fprintf(stderr, "%s\n", row.error().message.c_str());
            return Exit::Differs;
        }
        rows.push_back(std::move(*row));
    }
    progress.clear();
    if (json) {
        Json all = Json::array();
        for (const Measured& m : rows) all.push_back(asJson(m));
        print(documentOf(std::move(all), rows.size() == cases.size()));
    } else if (!rows.empty()) {
        printTable(rows);
    }
    if (rows.size() != cases.size())
        return stopped("with " + std::to_string(rows.size()) + " of " +
                       std::to_string(cases.size()) + " worlds measured");
    return Exit::Done;
}

}  // namespace huestep::tools
