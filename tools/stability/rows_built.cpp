// Rows 19 to 26: what is built with care, what is driven, and what is shot at a wall.
#include "core/math/trig.h"
#include "tools/stability/measures.h"
#include "tools/stability/rows.h"

namespace huestep::tools::stability {

namespace {

constexpr double quarterTurn = 0.5 * pi;  // rad

Row arch() {
    Trial trial;
    trial.scene = "arch";
    trial.criteria = {{"farthest shift aside", "m", 0.2, farthestAside}};
    return {19, "arch", {trial}};
}

/// A card has fallen if it is a quarter of its length from where it stood, or has turned by 30°.
Row cardHouse() {
    Trial trial;
    trial.scene = "card_house:levels=5";
    Criterion criterion{"fallen cards", "cards", 2.0, fallen(0.1, quarterTurn / 3.0)};
    criterion.mayReach = true;
    trial.criteria = {criterion};
    return {20, "card house", {trial}};
}

Row confined() {
    Trial trial;
    trial.scene = "confined:side=25";
    trial.criteria = {{"rms speed in the last second", "m/s", 0.01, rmsSpeed, Fold::Rms, 19.0},
                      {"farthest centre outside of the room", "m", 0.0, outside(10.0)}};
    trial.energyRule = false;
    trial.speedRule = false;
    return {21, "confined", {trial}};
}

/// μ = 1.37 tan 20°.
Row creep() {
    Trial trial;
    trial.scene = "ramp:angle=20,friction=0.4986";
    trial.seconds = 60.0;
    trial.criteria = {{"creep within a minute", "m", 0.01, farthestMoved}};
    return {22, "creep", {trial}};
}

/// One that lies on its neighbour's foot has turned by some 80°, one that leans by less than 30°.
Row dominoes() {
    Trial trial;
    trial.scene = "dominoes:n=15";
    Criterion criterion{"dominoes that stand at the end", "dominoes", 0.0,
                        standing(quarterTurn / 2.0)};
    criterion.mayReach = true;
    criterion.from = 19.0;
    trial.criteria = {criterion};
    return {23, "dominoes", {trial}};
}

Row hub() {
    Row row{24, "hub", {}};
    for (const char* scene : {"hub:n=1000,kinematic=0", "hub:n=1000,kinematic=1"}) {
        Trial trial;
        trial.scene = scene;
        Criterion criterion{"residual at the hub, over that of key order", "1", 1.2, hubResidual};
        criterion.from = 0.5;
        criterion.every = 0.5;
        criterion.mayReach = true;
        trial.criteria = {criterion};
        trial.againstKeyOrder = true;
        trial.energyRule = false;  // the discs are pressed
        row.trials.push_back(std::move(trial));
    }
    return row;
}

/// The walls of the drum reach from 9.5 to 10.5 m from its axle, which is 10 m above the origin.
Row tumbler() {
    const BodyId drum = 2;
    Trial trial;
    trial.scene = "tumbler:count=45";
    trial.criteria = {
        {"farthest centre beyond the middle of the walls", "m", 0.0, outsideDrum(drum, 10.0)},
        {"kinetic energy, of weight times the drum's width", "1", 1.0, kineticShare(drum, 20.0)}};
    trial.energyRule = false;  // the drum is driven
    return {25, "tumbler", {trial}};
}

/// The wall's near face is at x = −1 cm, its far one at 1 cm.
Row bullets() {
    Row row{26, "bullet", {}};
    for (const char* scene : {"bullet:speed=200", "whirling_rod:speed=50"}) {
        Trial trial;
        trial.scene = scene;
        trial.criteria = {{"farthest into the wall", "m", 0.02, beyond(-0.01)}};
        trial.speedRule = false;  // it starts with more
        row.trials.push_back(std::move(trial));
    }
    return row;
}

}  // namespace

void addBuiltRows(std::vector<Row>& rows) {
    rows.push_back(arch());
    rows.push_back(cardHouse());
    rows.push_back(confined());
    rows.push_back(creep());
    rows.push_back(dominoes());
    rows.push_back(hub());
    rows.push_back(tumbler());
    rows.push_back(bullets());
}

}  // namespace huestep::tools::stability
