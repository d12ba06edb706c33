/// The rows of the suite as data: which scenes, for how long, and what they must hold.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "tools/stability/criterion.h"

namespace huestep::tools::stability {

/// A scene of a row. Values; the criteria are functions without state.
struct Trial {
    int row = 0;
    std::string scene;  ///< of the catalog, not yet placed: "stack:n=10"
    double seconds = 20.0;
    std::vector<Criterion> criteria;
    bool energyRule = true;  ///< false: the row drives, overlaps or exceeds it by its set-up
    bool speedRule = true;
    bool judged = true;          ///< false: reported only
    std::uint32_t substeps = 0;  ///< that the row asks for; 0: those of the configuration
    /// The value is that of its only criterion over that of key order: method `sequential`.
    bool againstKeyOrder = false;
    /// A parameter of the scene in ticks, and how many seconds it stands for: it grows with the
    /// rate. Empty: none.
    std::string ticksParameter;
    double ticksSeconds = 0.0;
};

/// Where a trial's scene stands and how fast it ticks.
struct Placing {
    double turn = 0.0;  ///< degrees
    double far = 0.0;   ///< km
    double hz = 60.0;
};

inline constexpr double turnedBy = 37.0;  ///< degrees, of every scene's second run
inline constexpr std::uint64_t suiteSeed = 1;

/// The text by which `huestep run` knows the scene: "stack:n=10,seed=1,turn=37".
std::string textOf(const Trial& trial, const Placing& placing);

/// A row that has scenes of its own: 1 to 26.
struct Row {
    int number = 0;
    std::string_view name;
    std::vector<Trial> trials;
};
const std::vector<Row>& sceneRows();

// By area; `sceneRows` puts them together. Internal to tools/stability.
void addStackRows(std::vector<Row>& rows);  ///< 1 to 10
void addJointRows(std::vector<Row>& rows);  ///< 11 to 18
void addBuiltRows(std::vector<Row>& rows);  ///< 19 to 26

}  // namespace huestep::tools::stability
