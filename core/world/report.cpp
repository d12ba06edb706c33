#include "core/world/world.h"

namespace huestep {

std::string_view nameOf(Stage stage) {
    switch (stage) {
        case Stage::Commands:
            return "commands";
        case Stage::Pairs:
            return "pairs";
        case Stage::Collide:
            return "collide";
        case Stage::Colour:
            return "islands and colours";
        case Stage::Prepare:
            return "prepare";
        case Stage::Solve:
            return "solve";
        case Stage::Store:
            return "store";
        case Stage::Batches:
            return "batches";
        case Stage::Finish:
            return "finish";
        case Stage::Continuous:
            return "continuous";
        case Stage::Sleep:
            return "sleep";
        case Stage::Count:
            break;
    }
    return "unknown";
}

}  // namespace huestep
