/// What to draw of a world: the View that a server sends to who watches, and that a page which
/// steps a world of its own makes of it.
#pragma once

#include <array>
#include <cstdint>

#include "core/world/world.h"
#include "protocol/messages.h"

namespace huestep::protocol {

/// Tells when the shapes of a world's View are others than they were.
class DefinitionsMark {
 public:
    /// Notes the world as it is. True: bodies or shapes have come or gone since the last note.
    bool note(const World& world);

 private:
    std::array<std::uint64_t, 4> m_mark{};
};

/// The View of a world, but for `players` and `definitions`, which whoever sends it fills in. At
/// most `most` each of bodies, shapes, contacts and joints. `withShapes`: also what does not move.
View drawingOf(const World& world, bool withShapes, std::size_t most);

}  // namespace huestep::protocol
