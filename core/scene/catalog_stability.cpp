// The entries of the stability suite's own scenes.
#include "core/scene/catalog.h"
#include "core/scene/scenes.h"

namespace huestep::scenes {

namespace {

constexpr std::uint32_t twentySeconds = 1200;

std::vector<CatalogEntry> stackedCatalog() {
    return {
        {"big_box",
         "a box of 20 m falls on two of 1 m: nothing may be pressed through the ground",
         twentySeconds,
         {{"thick", 0, 0, 1, "0: the ground is a segment; 1: a slab"}},
         bigBox},
        {"confined",
         "more discs than a room has space for: they must come to rest inside",
         twentySeconds,
         {{"side", 25, 1, 25, "discs along a side"}},
         confined},
        {"dropped_stack",
         "boxes above each other with gaps between, which fall into a stack",
         twentySeconds,
         {{"n", 15, 1, 200, "boxes"}, {"gap", 0.1, 0, 1, "m between two boxes", false}},
         droppedStack},
        {"heavy_pyramids",
         "three pyramids on whose tops boxes of 100, 200 and 300 times the density drop",
         twentySeconds,
         {{"base", 10, 1, 30, "boxes in the lowest row"}},
         heavyPyramids},
        {"heavy_top",
         "a heavy box on a stack of light ones: it must not sink in",
         twentySeconds,
         {{"ratio", 100, 1, 1e6, "mass of the box, in light ones", false},
          {"n", 5, 1, 200, "light boxes"}},
         heavyTop},
        {"hub",
         "discs pressed on a large one from all sides: a body with very many contacts",
         twentySeconds,
         {{"n", 1000, 3, 1000, "discs"}, {"kinematic", 0, 0, 1, "1: the large disc is held"}},
         hub,
         hubHost},
        {"overlap",
         "a pyramid of boxes drawn into each other: they must part gently",
         twentySeconds,
         {{"n", 10, 1, 500, "boxes"}, {"share", 25, 0, 99, "% of their side", false}},
         overlap},
        {"release",
         "two light discs under a heavy one that is taken away: nothing may leap up",
         twentySeconds,
         {{"after", 120, 1, 1e6, "ticks until it is taken away"}},
         release,
         releaseHost},
        {"tower",
         "boxes of 1, 2, 4 m and so on upwards, the smallest at the bottom",
         twentySeconds,
         {{"n", 6, 1, 10, "boxes"}},
         tower},
    };
}

std::vector<CatalogEntry> builtCatalog() {
    return {
        {"arch", "17 stones without mortar, and 4 blocks upon them", twentySeconds, {}, arch},
        {"ball_and_chain",
         "a heavy disc on a chain, released horizontally",
         twentySeconds,
         {{"n", 40, 1, 200, "links"}},
         ballAndChain},
        {"bridge",
         "planks on joints between two banks",
         twentySeconds,
         {{"n", 160, 2, 500, "planks"}},
         bridge},
        {"bullet",
         "a small disc shot at a wall of 2 cm: it must not pass",
         twentySeconds,
         {{"speed", 200, 1, 1000, "m/s", false}},
         bullet},
        {"card_house",
         "cards of 0.4 m x 2 mm that lean on each other",
         twentySeconds,
         {{"levels", 5, 1, 8, "levels"}},
         cardHouse},
        {"dominoes",
         "a row of dominoes of which the first is pushed: all must fall",
         twentySeconds,
         {{"n", 15, 2, 100, "dominoes"}},
         dominoes,
         dominoesHost},
        {"stretched_chain",
         "a chain that hangs torn apart at the start: its joints must close gently",
         twentySeconds,
         {{"n", 40, 1, 500, "links"},
          {"stretch", 2, 1, 4, "of the length that its joints want", false}},
         stretchedChain},
        {"whirling_rod",
         "a rod that whirls into a wall of 2 cm: it must not pass",
         twentySeconds,
         {{"speed", 50, 1, 1000, "rad/s", false}},
         whirlingRod},
    };
}

}  // namespace

std::vector<CatalogEntry> stabilityCatalog() {
    std::vector<CatalogEntry> all = stackedCatalog();
    for (CatalogEntry& entry : builtCatalog()) all.push_back(std::move(entry));
    return all;
}

}  // namespace huestep::scenes
