#include "protocol/fingerprint.h"

#include <span>
#include <string>

#include "core/rules/rules.h"
#include "core/scene/catalog.h"
#include "core/state/hash.h"
#include "core/state/snapshot.h"
#include "core/world/world.h"
#include "protocol/scene_file.h"
#include "protocol/schema_text.h"

namespace huestep::protocol {

std::uint64_t schemaHash(std::string_view text) {
    // No string of our schemas holds a '#', so every one starts a comment.
    std::string kept;
    bool comment = false;
    for (const char c : text) {
        if (c == '#') comment = true;
        if (c == '\n') comment = false;
        if (comment) continue;
        const bool space = c == ' ' || c == '\n' || c == '\t' || c == '\r';
        if (!space) {
            kept += c;
        } else if (!kept.empty() && kept.back() != ' ') {
            kept += ' ';
        }
    }
    return hash64(std::as_bytes(std::span(kept.data(), kept.size())));
}

Fingerprint buildFingerprint() {
    static const std::uint64_t hash = schemaHash(std::string(sceneSchemaText) + messagesSchemaText);
    return {0, hash, (snapshotVersion << 16) | sceneVersion};
}

Result<Fingerprint> selfTest() {
    constexpr int ticks = 120;
    const Result<Scene> scene = sceneFromCatalog("mixed");
    if (!scene) return scene.error();
    Result<World> world = World::create(*scene);
    if (!world) return world.error();
    for (int tick = 0; tick < ticks; ++tick) world->step({});
    Fingerprint fingerprint = buildFingerprint();
    fingerprint.selfTest = world->fullRoot();
    return fingerprint;
}

std::uint64_t rulesMark(std::string_view name, std::uint32_t version) {
    const std::string text = std::string(name) + " " + std::to_string(version);
    return hash64(std::as_bytes(std::span(text.data(), text.size())));
}

std::vector<std::uint64_t> builtInRulesMarks() {
    std::vector<std::uint64_t> marks;
    for (const Rules* const rules : builtInRules()) {
        marks.push_back(rulesMark(rules->name(), rules->version()));
    }
    return marks;
}

}  // namespace huestep::protocol
