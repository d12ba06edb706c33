/// The questions that this project began with, answered with data: when does colouring pay, what do
/// the other ways to share work among threads cost, what is left to one thread, who waits?
#pragma once

#include <array>
#include <string>
#include <vector>

#include "tools/chart/run.h"

namespace huestep::tools::chart {

/// How the constraints of a scene are gone through.
enum Way : std::size_t {
    keyOrder,       ///< one after another on one thread, as their keys sort
    colours,        ///< by colours on one thread, in lanes
    coloursChosen,  ///< by colours on two threads where the product thinks it worth while
    coloursAlways,  ///< by colours on two threads, whatever it costs
    wayCount
};

/// A scene by each way. Times are the clock's: two threads are there to finish earlier.
struct WaysRow {
    std::string family;  ///< of scenes that differ in size alone; empty: none
    std::shared_ptr<const NamedScene> scene;
    std::size_t bodies = 0;
    std::uint32_t contacts = 0;
    std::uint32_t joints = 0;
    std::uint32_t islands = 0;
    std::uint32_t colours = 0;
    std::uint32_t overflow = 0;   ///< constraints beyond the last colour
    std::uint32_t inBuckets = 0;  ///< contacts of hubs
    std::array<Run, wayCount> runs;
    double waited = 0.0;  ///< share of two threads' time, as the product shares work

    [[nodiscard]] std::uint32_t constraints() const { return contacts + joints; }
    /// Least time of one way over that of another, by the clock.
    [[nodiscard]] double ratio(Way way, Way other) const;
};

/// Growing piles and nets, one island each.
Result<bool> measureSizes(Extent extent, std::vector<WaysRow>& rows);

/// The benchmark scenes.
Result<bool> measureScenes(Extent extent, std::vector<WaysRow>& rows);

/// A method on a scene that can be shared: what it costs and how wrong it is after the run.
struct PriceRow {
    Run run;
    double penetration = 0.0;  ///< m, largest at the end
    double jointError = 0.0;   ///< m, likewise
    std::string failure;       ///< empty: none
};
Result<bool> measurePrices(Extent extent, std::vector<PriceRow>& rows);

/// A flat row for each way.
void addRows(Json& rows, const WaysRow& row);
Json asJson(const PriceRow& row);

}  // namespace huestep::tools::chart
