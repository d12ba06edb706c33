// The benchmark scenes, set up as in Box2D's own benchmark set (performance page, "Scenes"), so
// that anyone can compare.
#include "core/math/trig.h"
#include "core/scene/scenes.h"

namespace huestep::scenes {

namespace {

/// A pyramid of boxes of half size `half` in rows from `base` to 1; `left` is the left end of its
/// lowest row and `floor` the height it stands on.
void addPyramid(Scene& scene, std::uint32_t base, float half, float left, float floor) {
    const ShapeDef box = ShapeDef::box(half, half);
    for (std::uint32_t row = 0; row < base; ++row) {
        const float y = floor + (2.0f * static_cast<float>(row) + 1.0f) * half;
        for (std::uint32_t column = row; column < base; ++column) {
            const float x = left + (static_cast<float>(row) + 1.0f) * half +
                            2.0f * static_cast<float>(column - row) * half;
            add(scene, bodyOf(BodyType::Dynamic, {x, y}, box));
        }
    }
}

}  // namespace

Scene pyramid(Values values) {
    const std::uint32_t base = count(values[0]);
    Scene scene;
    scene.sleep = false;
    add(scene, bodyOf(BodyType::Static, {0.0f, -1.0f}, ShapeDef::box(100.0f, 1.0f)));
    const float half = 0.5f;
    addPyramid(scene, base, half, -half * static_cast<float>(base), 0.0f);
    fitLimits(scene);
    return scene;
}

Scene manyPyramids(Values values) {
    const std::uint32_t rows = count(values[0]);
    const std::uint32_t columns = count(values[1]);
    const std::uint32_t base = count(values[2]);
    const float half = 0.5f;
    const float pitch = 2.0f * half * (static_cast<float>(base) + 1.0f);
    const float width = pitch * static_cast<float>(columns);
    Scene scene;
    scene.sleep = false;
    BodyDef ground;
    for (std::uint32_t row = 0; row < rows; ++row) {
        const float y = static_cast<float>(row) * pitch;
        ground.shapes.push_back(ShapeDef::segment({-0.5f * width, y}, {0.5f * width, y}));
    }
    add(scene, ground);
    for (std::uint32_t row = 0; row < rows; ++row) {
        for (std::uint32_t column = 0; column < columns; ++column) {
            const float left = -0.5f * width + static_cast<float>(column) * pitch + half;
            addPyramid(scene, base, half, left, static_cast<float>(row) * pitch);
        }
    }
    fitLimits(scene);
    return scene;
}

Scene jointGrid(Values values) {
    const std::uint32_t n = count(values[0]);
    ShapeDef disc = ShapeDef::circle({}, 0.4f);
    disc.filter.category = 2u;
    disc.filter.mask = ~2u;
    JointDef above;
    above.anchorA = {0.0f, -0.5f};
    above.anchorB = {0.0f, 0.5f};
    JointDef left;
    left.anchorA = {0.5f, 0.0f};
    left.anchorB = {-0.5f, 0.0f};
    Scene scene;
    scene.sleep = false;
    for (std::uint32_t k = 0; k < n; ++k) {
        for (std::uint32_t i = 0; i < n; ++i) {
            const bool held = i == 0 && k + 3 >= n / 2 && k <= n / 2 + 3;
            const Vec2 position{static_cast<float>(k), -static_cast<float>(i)};
            const std::uint32_t place =
                add(scene, bodyOf(held ? BodyType::Static : BodyType::Dynamic, position, disc));
            above.bodyB = left.bodyB = place;
            if (i > 0) {
                above.bodyA = place - 1;
                scene.joints.push_back(above);
            }
            if (k > 0) {
                left.bodyA = place - n;
                scene.joints.push_back(left);
            }
        }
    }
    fitLimits(scene);
    return scene;
}

Scene tumbler(Values values) {
    const std::uint32_t side = count(values[0]);
    Scene scene;
    const std::uint32_t ground = add(scene, BodyDef{});
    BodyDef drum;
    drum.type = BodyType::Dynamic;
    drum.position = {0.0f, 10.0f};
    drum.shapes = {
        ShapeDef::box(0.5f, 10.0f, {10.0f, 0.0f}), ShapeDef::box(0.5f, 10.0f, {-10.0f, 0.0f}),
        ShapeDef::box(10.0f, 0.5f, {0.0f, 10.0f}), ShapeDef::box(10.0f, 0.5f, {0.0f, -10.0f})};
    for (ShapeDef& wall : drum.shapes) wall.density = 50.0f;
    JointDef axle = hingeAt(scene, ground, ground, drum.position);
    axle.bodyB = add(scene, drum);
    axle.anchorB = {};
    axle.motor = {true, static_cast<float>(25.0 * pi / 180.0), 1.0e8f};
    scene.joints.push_back(axle);
    const ShapeDef box = ShapeDef::box(0.125f, 0.125f);
    const float low = -0.2f * static_cast<float>(side);
    for (std::uint32_t row = 0; row < side; ++row) {
        for (std::uint32_t column = 0; column < side; ++column) {
            const Vec2 position{low + 0.4f * static_cast<float>(column),
                                low + 0.4f * static_cast<float>(row) + 10.0f};
            add(scene, bodyOf(BodyType::Dynamic, position, box));
        }
    }
    fitLimits(scene);
    return scene;
}

Scene small(Values values) {
    const std::uint32_t boxes = count(values[0]);
    Scene scene;
    scene.sleep = values[1] != 0.0;
    add(scene, bodyOf(BodyType::Static, {0.0f, -1.0f}, ShapeDef::box(20.0f, 1.0f)));
    const ShapeDef box = ShapeDef::box(0.5f, 0.5f);
    for (std::uint32_t i = 0; i < boxes; ++i) {
        const float x = static_cast<float>(i % 3) - 1.0f;
        const float y = static_cast<float>(i / 3) + 0.5f;
        add(scene, bodyOf(BodyType::Dynamic, {x, y}, box));
    }
    const float top = static_cast<float>((boxes + 2) / 3);
    const ShapeDef disc = ShapeDef::circle({}, 0.5f);
    add(scene, bodyOf(BodyType::Dynamic, {0.25f, top + 3.0f}, disc));
    return scene;
}

}  // namespace huestep::scenes
