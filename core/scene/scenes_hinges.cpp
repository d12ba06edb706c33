// Columns of boxes, hinged in pairs, that topple, come to rest and fall asleep: a scene that walks
// through contacts, limits, springs and sleep within a few seconds. Used for golden hashes.
#include "core/scene/scenes.h"

namespace huestep::scenes {

Scene hinges(Values values) {
    const std::uint32_t columns = count(values[0]);
    const std::uint32_t rows = count(values[1]);
    Scene scene;
    ShapeDef floor = ShapeDef::box(30.0f, 1.0f);
    add(scene, bodyOf(BodyType::Static, {0.0f, -1.0f}, floor));
    const float half = 0.25f;
    ShapeDef box = ShapeDef::box(half - 0.03f, half - 0.03f, {}, {}, 0.03f);
    box.material.friction = 0.3f;
    const float lean = 0.4f * half;
    const float pitch = 10.0f * half;
    for (std::uint32_t column = 0; column < columns; ++column) {
        const float first =
            pitch * (static_cast<float>(column) - 0.5f * (static_cast<float>(columns) - 1.0f));
        for (std::uint32_t row = 0; row < rows; ++row) {
            const float height = 2.0f * half * static_cast<float>(row);
            const Vec2 position{first + lean * static_cast<float>(row), half + height};
            const std::uint32_t place = add(scene, bodyOf(BodyType::Dynamic, position, box));
            if (row % 2 == 0) continue;
            // The hinge sits at the right edge of the seam between a box and the one below it.
            JointDef hinge = hingeAt(scene, place - 1, place, {position.x + half, height});
            hinge.limit = {true, -0.3f, 0.6f};
            hinge.spring = {true, 0.5f, 0.5f};
            hinge.collideConnected = true;
            scene.joints.push_back(hinge);
        }
    }
    fitLimits(scene);
    return scene;
}

}  // namespace huestep::scenes
