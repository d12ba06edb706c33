/// The built-in scenes, by name and parameters.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "core/scene/scene.h"
#include "core/scene/script.h"

namespace huestep {

struct SceneParameter {
    std::string_view name;
    double standard = 0.0;  ///< value if not given
    double low = 0.0;
    double high = 0.0;
    std::string_view meaning;  ///< with its unit
    bool whole = true;         ///< takes whole numbers alone
};

struct CatalogEntry {
    std::string_view name;
    std::string_view purpose;  ///< what the scene is for, one line
    std::uint32_t ticks = 0;   ///< how long it is run by default
    std::vector<SceneParameter> parameters;
    /// Builds it; `values` holds one number a parameter, in order, within range.
    Scene (*build)(std::span<const double> values) = nullptr;
    Script::Rule script = nullptr;  ///< what its host does, tick by tick; null: nothing
};

/// All built-in scenes, by name.
std::span<const CatalogEntry> sceneCatalog();

/// What every scene takes beside its own parameters: a `Placement`, and ticks a second. What hosts
/// do goes by ticks.
std::span<const SceneParameter> commonParameters();

/// A scene from `name` or `name:parameter=value,parameter=value`; it passes `check`, and its name
/// is the text. Numbers are read as in C, without locale. The sentence of a failure names
/// the unknown scene or parameter, or the value out of range, and what there is instead.
Result<Scene> sceneFromCatalog(std::string_view text);

/// What the host of the scene of this text does; of most scenes, nothing. Fails as
/// `sceneFromCatalog` does.
Result<Script> scriptFromCatalog(std::string_view text);

/// How the scene of this text is placed. Fails as `sceneFromCatalog` does.
Result<Placement> placementFromCatalog(std::string_view text);

/// The entry that `text` names, parameters aside; null if there is none.
const CatalogEntry* findInCatalog(std::string_view text);

}  // namespace huestep
