// `huestep bench --scale`: how time and memory grow with the world.
#include <algorithm>
#include <cstdio>
#include <optional>
#include <utility>

#if defined(__GLIBC__)
#include <malloc.h>
#endif

#include "core/world/world.h"
#include "tools/bench_modes.h"
#include "tools/clock.h"
#include "tools/interrupt.h"
#include "tools/machine.h"
#include "tools/progress.h"
#include "tools/scene_source.h"
#include "tools/statistics.h"
#include "tools/text.h"

namespace huestep::tools {
namespace {

/// A world of some size, and when it is as it stays: rain falls for 170 ticks before it lands, and
/// a ragdoll is there for 320.
struct Size {
    const char* scene;
    std::uint64_t settleTicks;
    bool quick;
};
constexpr Size sizes[] = {
    {"pyramid:base=13", 60, true},
    {"pyramid:base=44", 60, true},
    {"pyramid:base=140", 60, false},
    {"pyramid:base=446", 30, false},
    {"rain:floors=1,columns=2,group=5,period=160", 330, true},
    {"rain:floors=2,columns=9,group=5,period=36", 330, true},
    {"rain:floors=5,columns=36,group=5,period=9", 330, false},
    {"many_pyramids:rows=3,columns=4,base=4", 60, true},
    {"many_pyramids:rows=10,columns=10,base=4", 60, true},
    {"many_pyramids:rows=16,columns=11,base=10", 60, false},
    {"many_pyramids:rows=40,columns=40,base=10", 30, false},
};

struct Measured {
    std::string scene;
    int threads = 1;
    std::size_t bodies = 0;
    std::uint32_t contacts = 0;
    std::uint64_t ticks = 0;  // measured
    double msPerTick = 0;     // median
    std::optional<double> bytesPerBody;
    std::uint64_t hash = 0;

    [[nodiscard]] double nsPerBody() const {
        return 1e6 * msPerTick / static_cast<double>(std::max<std::size_t>(bodies, 1));
    }
};

/// Bytes that this program has from its allocator, everywhere; nothing where that does not say.
std::optional<std::size_t> allocatedBytes() {
#if defined(__GLIBC__) && __GLIBC_PREREQ(2, 33)
    const struct mallinfo2 all = mallinfo2();
    if (all.uordblks + all.hblkhd > 0) return all.uordblks + all.hblkhd;
#endif
    return std::nullopt;
}

/// More ticks of small worlds, for their clock is coarse.
std::uint64_t ticksFor(std::size_t bodies, bool quick) {
    const std::size_t work = quick ? 50'000 : 1'000'000;
    return std::clamp<std::uint64_t>(work / std::max<std::size_t>(bodies, 1), 10, 300);
}

Result<Measured> measure(const Size& size, int threads, bool quick) {
    const Result<NamedScene> named = loadScene(size.scene);
    if (!named) return named.error();
    Executor executor(threads);
    const StepResources with{&executor};
    const std::optional<std::size_t> before = allocatedBytes();
    Result<World> made = World::create(named->scene);
    if (!made) return made.error();
    World& world = *made;
    Measured m;
    m.scene = size.scene;
    m.threads = threads;
    Progress progress(m.scene, size.settleTicks);
    while (world.tick() < size.settleTicks && !interrupted()) {
        world.step(named->script.commands(world.tick()), with);
        progress.advance();
    }
    m.ticks = ticksFor(world.bodies().size(), quick);
    std::vector<double> milliseconds;
    for (std::uint64_t i = 0; i < m.ticks && !interrupted(); ++i) {
        const std::vector<Command> commands = named->script.commands(world.tick());
        const std::uint64_t begin = nanoseconds();
        world.step(commands, with);
        milliseconds.push_back(static_cast<double>(nanoseconds() - begin) / 1e6);
    }
    m.msPerTick = quantile(milliseconds, 0.5);
    m.bodies = world.bodies().size();
    m.contacts = world.report().contacts;
    const std::optional<std::size_t> after = allocatedBytes();
    if (before && after && m.bodies > 0)
        m.bytesPerBody = (static_cast<double>(*after) - static_cast<double>(*before)) /
                         static_cast<double>(m.bodies);
    m.hash = world.fullRoot();
    return m;
}

Json asJson(const Measured& m) {
    Json row = {{"scene", m.scene},
                {"threads", m.threads},
                {"bodies", m.bodies},
                {"contacts", m.contacts},
                {"ticks", m.ticks},
                {"ms_per_tick", m.msPerTick},
                {"ns_a_body_and_tick", m.nsPerBody()}};
    row["bytes_a_body"] = m.bytesPerBody ? Json(*m.bytesPerBody) : Json(nullptr);
    row["hash"] = hex(m.hash);
    return row;
}

void printTable(const std::vector<Measured>& rows) {
    std::printf("%s\n", originLine().c_str());
    Table table({"scene", "threads", "bodies", "contacts", "ms a tick", "ns a body and tick",
                 "B a body", "hash"});
    for (const Measured& m : rows)
        table.add(
            {m.scene, std::to_string(m.threads), std::to_string(m.bodies),
             std::to_string(m.contacts), number(m.msPerTick), number(m.nsPerBody()),
             m.bytesPerBody ? std::to_string(static_cast<std::uint64_t>(*m.bytesPerBody)) : "-",
             hex(m.hash)});
    table.print();
    std::printf(
        "Time: median of the ticks once the scene has settled. Memory: what the world holds of the "
        "allocator then,\nstate, caches and working memory, its contacts included; the scene's own "
        "definition apart.\n");
}

}  // namespace

Answer benchScale(const std::vector<int>& threads, bool quick, bool json) {
    std::vector<Measured> rows;
    bool finished = true;
    for (const Size& size : sizes) {
        if (quick && !size.quick) continue;
        const std::size_t first = rows.size();
        for (const int count : threads) {
            Result<Measured> row = measure(size, count, quick);
            finished = !interrupted();
            if (!finished) break;
            if (!row) return row.error();
            if (rows.size() > first && row->hash != rows[first].hash) {
                std::fprintf(stderr, "%s: %d threads come to another state than %d\n", size.scene,
                             count, threads.front());
                return Exit::Differs;
            }
            std::fprintf(stderr, "%s: %zu bodies, %d thread%s: %s ns a body and tick\n", size.scene,
                         row->bodies, count, count == 1 ? "" : "s",
                         number(row->nsPerBody()).c_str());
            rows.push_back(std::move(*row));
        }
        if (!finished) break;
    }
    if (json) {
        Json all = Json::array();
        for (const Measured& m : rows) all.push_back(asJson(m));
        print(documentOf(std::move(all), finished));
    } else if (!rows.empty()) {
        printTable(rows);
    }
    if (!finished) return stopped("with " + std::to_string(rows.size()) + " rows measured");
    return Exit::Done;
}

}  // namespace huestep::tools
