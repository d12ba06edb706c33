#include "core/state/roots.h"

#include <array>

#include "core/state/hash.h"

namespace huestep {

namespace {

template <class Record>
std::uint64_t treeOf(const std::vector<Record>& array) {
    return rootOf(leavesOf(std::as_bytes(std::span(array)), sizeof(Record)));
}

}  // namespace

std::vector<std::uint64_t> leavesOf(std::span<const std::byte> bytes, std::size_t recordBytes) {
    const std::size_t leafBytes = recordBytes * recordsPerLeaf;
    std::vector<std::uint64_t> leaves;
    leaves.reserve((bytes.size() + leafBytes - 1) / leafBytes);
    for (std::size_t at = 0; at < bytes.size(); at += leafBytes) {
        leaves.push_back(hash64(bytes.subspan(at, std::min(leafBytes, bytes.size() - at))));
    }
    return leaves;
}

std::uint64_t rootOf(std::vector<std::uint64_t> nodes) {
    if (nodes.empty()) return 0;
    while (nodes.size() > 1) {
        std::size_t parents = 0;
        for (std::size_t at = 0; at < nodes.size(); at += childrenPerNode) {
            const std::size_t count = std::min(childrenPerNode, nodes.size() - at);
            nodes[parents++] = hash64Of(std::span<const std::uint64_t>(&nodes[at], count));
        }
        nodes.resize(parents);
    }
    return nodes[0];
}

std::vector<std::uint64_t> motionLeaves(const WorldState& state) {
    return leavesOf(std::as_bytes(std::span(state.motions)), sizeof(BodyMotion));
}

std::uint64_t motionRoot(const WorldState& state) {
    const WorldInfo& info = state.info();
    std::array<std::uint64_t, 8> all{rootOf(motionLeaves(state)),
                                     info.tick,
                                     state.motions.size(),
                                     info.nextBody,
                                     info.nextShape,
                                     info.nextJoint};
    if (state.rules.empty()) return hash64Of(std::span<const std::uint64_t>(all).first(6));
    all[6] = treeOf(state.rules);
    all[7] = treeOf(state.rulesWords);
    return hash64Of(std::span<const std::uint64_t>(all));
}

std::uint64_t fullRoot(const WorldState& state, RootCache& cache) {
    std::vector<std::uint64_t> definitions;
    std::vector<std::uint64_t> all;
    forEachArray(state, [&](std::string_view, const auto& array) {
        using Record = std::remove_cvref_t<decltype(array[0])>;
        if (isOfRules<Record> && state.rules.empty()) return;
        if constexpr (isDefinition<Record>) {
            if (!cache.definitionsKnown) definitions.push_back(treeOf(array));
        } else {
            all.push_back(treeOf(array));
            all.push_back(array.size());
        }
    });
    if (!cache.definitionsKnown) {
        cache.definitions = hash64Of(std::span<const std::uint64_t>(definitions));
        cache.definitionsKnown = true;
    }
    all.push_back(cache.definitions);
    return hash64Of(std::span<const std::uint64_t>(all));
}

}  // namespace huestep
