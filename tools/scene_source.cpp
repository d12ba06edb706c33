#include "tools/scene_source.h"

#include <filesystem>

#include "core/scene/catalog.h"
#include "protocol/scene_file.h"
#include "tools/files.h"

namespace huestep::tools {
namespace {

constexpr std::uint32_t fileTicks = 600;  // ten seconds at 60 Hz: a file does not say

}  // namespace

Result<NamedScene> loadScene(const std::string& text) {
    if (const CatalogEntry* entry = findInCatalog(text)) {
        Result<Scene> scene = sceneFromCatalog(text);
        if (!scene) return scene.error();
        Result<Script> script = scriptFromCatalog(text);
        if (!script) return script.error();
        return NamedScene{text, std::move(scene).value(), entry->ticks, std::move(script).value()};
    }
    std::error_code wrong;
    if (!std::filesystem::exists(text, wrong)) {
        // Neither: the catalog's sentence says what there is.
        const Result<Scene> unknown = sceneFromCatalog(text);
        return Error{unknown ? text + ": no scene"
                             : unknown.error().message + "; nor is there a file of this name"};
    }
    const Result<std::vector<std::byte>> bytes = readFile(text, protocol::maxSceneFileBytes);
    if (!bytes) return bytes.error();
    Result<Scene> scene = protocol::readScene(*bytes);
    if (!scene) return Error{text + ": " + scene.error().message};
    if (const Status fine = check(*scene); !fine) return Error{text + ": " + fine.error().message};
    return NamedScene{text, std::move(scene).value(), fileTicks, {}};
}

}  // namespace huestep::tools
