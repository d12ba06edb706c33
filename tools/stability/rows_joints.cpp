// Rows 11 to 18: chains, bridges, nets and what whirls on an arm.
#include "tools/stability/measures.h"
#include "tools/stability/rows.h"

namespace huestep::tools::stability {

namespace {

Criterion errorBelow(double limit) {
    return {"largest joint error", "m", limit, jointError};
}

Criterion errorBelowFrom(double limit, double seconds, const std::string& when) {
    Criterion criterion = errorBelow(limit);
    criterion.what += " " + when;
    criterion.from = seconds;
    return criterion;
}

/// No more than the rule for all rows says; named here because these rows are about it.
Criterion noEnergyGain() {
    return {"energy above the start's, of weight times extent", "1", 0.01, energyGain};
}

constexpr const char* inTheLastSecond = "in the last second";

/// A chain of ten links with a ball, for each ratio; the last one is beyond what is asked for.
Row chain(int number, std::string_view name, const std::string& angle,
          const std::vector<Criterion>& criteria) {
    Row row{number, name, {}};
    for (const char* ratio : {"100", "1000", "10000", "100000", "1000000"}) {
        Trial trial;
        trial.scene = std::string("chain:ratio=") + ratio + angle;
        trial.criteria = criteria;
        trial.judged = std::string(ratio) != "1000000";
        row.trials.push_back(std::move(trial));
    }
    return row;
}

Row ballAndChain() {
    Trial trial;
    trial.scene = "ball_and_chain:n=40";
    trial.criteria = {errorBelow(0.3), errorBelowFrom(0.1, 19.0, inTheLastSecond)};
    return {13, "ball and chain", {trial}};
}

Row bridge() {
    Trial trial;
    trial.scene = "bridge:n=160";
    trial.criteria = {errorBelow(0.1), errorBelowFrom(0.03, 19.0, inTheLastSecond)};
    return {14, "bridge", {trial}};
}

Row jointGrid() {
    Trial trial;
    trial.scene = "joint_grid:n=100,gravity=2";
    trial.criteria = {errorBelow(0.5)};
    return {15, "joint grid", {trial}};
}

Row stretchedChain() {
    Trial trial;
    trial.scene = "stretched_chain:n=40,stretch=2";
    trial.criteria = {{"fastest body", "m/s", 50.0, fastest},
                      errorBelowFrom(0.01, 5.0, "after 5 s")};
    trial.energyRule = false;  // torn joints hold no energy that counts
    trial.speedRule = false;
    return {16, "stretched chain", {trial}};
}

Row lightPendulum() {
    Row row{17, "light pendulum", {}};
    for (const std::uint32_t substeps : {1u, 2u, 4u, 8u, 16u, 32u, 64u}) {
        Trial trial;
        trial.scene = "pendulum:angle=90";
        trial.criteria = {noEnergyGain()};
        trial.substeps = substeps;
        row.trials.push_back(std::move(trial));
    }
    return row;
}

Row fastSpinner() {
    Row row{18, "fast spinner", {}};
    for (const int speed : {10, 30, 100}) {
        Trial trial;
        trial.scene = "arm:speed=" + std::to_string(speed);
        trial.seconds = 5.0;
        trial.criteria = {{"largest change of the radius, of the arm", "1", 0.01, armError},
                          {"loss of kinetic energy", "1", 0.05, kineticLoss}};
        trial.speedRule = false;  // 5 m at 30 rad/s are 150 m/s
        trial.judged = speed != 100;
        row.trials.push_back(std::move(trial));
    }
    return row;
}

}  // namespace

void addJointRows(std::vector<Row>& rows) {
    rows.push_back(chain(11, "hanging chain", "", {errorBelowFrom(0.01, 19.0, inTheLastSecond)}));
    rows.push_back(chain(12, "swinging chain", ",angle=90", {errorBelow(0.05), noEnergyGain()}));
    rows.push_back(ballAndChain());
    rows.push_back(bridge());
    rows.push_back(jointGrid());
    rows.push_back(stretchedChain());
    rows.push_back(lightPendulum());
    rows.push_back(fastSpinner());
}

}  // namespace huestep::tools::stability
