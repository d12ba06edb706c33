#include "tools/stability/rows.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "tools/text.h"

namespace huestep::tools::stability {

namespace {

void addParameter(std::string& text, const std::string& name, double value) {
    text += text.find(':') == std::string::npos ? ':' : ',';
    text += name + "=" + number(value);
}

}  // namespace

std::string textOf(const Trial& trial, const Placing& placing) {
    std::string text = trial.scene;
    if (!trial.ticksParameter.empty())
        addParameter(text, trial.ticksParameter, std::round(trial.ticksSeconds * placing.hz));
    addParameter(text, "seed", static_cast<double>(suiteSeed));
    if (placing.turn != 0.0) addParameter(text, "turn", placing.turn);
    if (placing.far != 0.0) addParameter(text, "far", placing.far);
    if (placing.hz != 60.0) addParameter(text, "hz", placing.hz);
    return text;
}

const std::vector<Row>& sceneRows() {
    static const std::vector<Row> rows = [] {
        std::vector<Row> all;
        addStackRows(all);
        addJointRows(all);
        addBuiltRows(all);
        for (Row& row : all)
            for (Trial& trial : row.trials) trial.row = row.number;
        return all;
    }();
    return rows;
}

}  // namespace huestep::tools::stability
