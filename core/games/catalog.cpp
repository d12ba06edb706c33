// The rules that this program knows. A game of one's own gets a line here.

#include <array>

#include "core/games/ball.h"
#include "core/games/building.h"
#include "core/rules/rules.h"

namespace huestep {

RulesSet builtInRules() {
    static const games::Ball ball;
    static const games::Building building;
    static const std::array<const Rules*, 2> all{&ball, &building};
    return all;
}

}  // namespace huestep
