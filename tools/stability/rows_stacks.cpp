// Rows 1 to 10: what stands on each other, or is pressed into each other.
#include "tools/stability/measures.h"
#include "tools/stability/rows.h"

namespace huestep::tools::stability {

namespace {

constexpr double whole = 20.0;  // s

Criterion moved(double limit) {
    return {"farthest that a body moved", "m", limit, farthestMoved};
}

Criterion turned(double limit) {
    return {"furthest that a body turned", "rad", limit, furthestTurned};
}

/// In the last second of a run of this length.
Criterion atTheEnd(Criterion criterion, double seconds) {
    criterion.from = seconds - 1.0;
    criterion.what += " in the last second";
    return criterion;
}

Criterion overlapBelow(double limit, double seconds = whole) {
    return atTheEnd({"deepest overlap", "m", limit, penetration}, seconds);
}

/// A stack stands if no box goes half a metre aside or turns by half a radian. How far it sinks is
/// no matter of standing: contacts give way under load by a law, 100 boxes by metres in all, and
/// where a row limits that, it does so by the overlap.
std::vector<Criterion> stands() {
    return {{"farthest shift aside", "m", 0.5, farthestAside}, turned(0.5)};
}

Row tallStack() {
    Row row{1, "tall stack", {}};
    for (const int boxes : {10, 15, 20, 40, 60, 100}) {
        Trial trial;
        trial.scene = "stack:n=" + std::to_string(boxes);
        trial.seconds = boxes == 100 ? 20.0 : 60.0;
        trial.criteria = stands();
        Criterion quiet{"rms speed", "m/s", 0.01, rmsSpeed, Fold::Rms};
        trial.criteria.push_back(atTheEnd(quiet, trial.seconds));
        row.trials.push_back(std::move(trial));
    }
    return row;
}

Row droppedStack() {
    Trial trial;
    trial.scene = "dropped_stack:n=15,gap=0.1";
    trial.criteria = {{"farthest shift aside", "m", 0.3, farthestAside}};
    return {2, "dropped stack", {trial}};
}

Row pyramid() {
    Trial trial;
    trial.scene = "pyramid:base=100";
    trial.seconds = 5.0;
    trial.criteria = {moved(0.5)};
    return {3, "pyramid", {trial}};
}

Row heavyOnLight() {
    Row row{4, "heavy on light", {}};
    for (const int boxes : {1, 5})
        for (const int ratio : {10, 100, 400, 1000}) {
            Trial trial;
            trial.scene =
                "heavy_top:ratio=" + std::to_string(ratio) + ",n=" + std::to_string(boxes);
            trial.criteria = stands();
            trial.criteria.push_back(overlapBelow(0.05));
            row.trials.push_back(std::move(trial));
        }
    return row;
}

Row ratioTower() {
    Trial trial;
    trial.scene = "tower:n=6";
    trial.criteria = {
        {"farthest shift aside", "m", 0.5, farthestAside}, turned(0.5), overlapBelow(0.05)};
    return {5, "ratio tower", {trial}};
}

Row bigBoxDrop(int number, std::string_view name, bool thick) {
    Trial trial;
    trial.scene = thick ? "big_box:thick=1" : "big_box:thick=0";
    trial.criteria = {{"lowest centre below the ground", "m", 0.0, lowest}, overlapBelow(0.1)};
    return {number, name, {trial}};
}

/// The tops fall 2 m before they rest: 400 kg and more, where other boxes have 4.
Row ratioPyramids() {
    Trial trial;
    trial.scene = "heavy_pyramids:base=10";
    const auto drop = [](const Tracked& body) { return body.mass > 100.0 ? 2.0 : 0.0; };
    trial.criteria = {{"farthest that a body is from its place", "m", 0.5, movedFromRest(drop)}};
    trial.criteria.back().from = 1.0;  // by then the tops have come down
    return {8, "ratio pyramids", {trial}};
}

Row released() {
    Trial trial;
    trial.scene = "release";
    trial.ticksParameter = "after";
    trial.ticksSeconds = 2.0;
    trial.criteria = {{"fastest body after the release", "m/s", 1.0, fastest}};
    trial.criteria.back().from = 2.0 + 1.0e-6;  // not the tick before it
    return {9, "release", {trial}};
}

Row overlapRecovery() {
    Row row{10, "overlap recovery", {}};
    for (const char* scene : {"overlap:n=10,share=25", "overlap:n=50,share=90"}) {
        Trial trial;
        trial.scene = scene;
        trial.criteria = {{"fastest body", "m/s", 3.0, fastest},
                          {"deepest overlap after 3 s", "m", 0.005, penetration}};
        trial.criteria.back().from = 3.0;
        trial.criteria.back().every = 0.1;
        trial.energyRule = false;
        trial.speedRule = false;
        row.trials.push_back(std::move(trial));
    }
    return row;
}

}  // namespace

void addStackRows(std::vector<Row>& rows) {
    rows.push_back(tallStack());
    rows.push_back(droppedStack());
    rows.push_back(pyramid());
    rows.push_back(heavyOnLight());
    rows.push_back(ratioTower());
    rows.push_back(bigBoxDrop(6, "big box drop", false));
    rows.push_back(bigBoxDrop(7, "big box drop on thick ground", true));
    rows.push_back(ratioPyramids());
    rows.push_back(released());
    rows.push_back(overlapRecovery());
}

}  // namespace huestep::tools::stability
