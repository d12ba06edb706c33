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

/// A grid of `columns` × `rows` boxes of half size `half`, column by column, `pitch` apart; `first`
/// is the place of the lowest box of the first column.
void addGrid(Scene& scene, std::uint32_t columns, std::uint32_t rows, float half, Vec2 first,
             float pitch, bool asleep = false) {
    BodyDef box = bodyOf(BodyType::Dynamic, first, ShapeDef::box(half, half));
    box.asleep = asleep;
    for (std::uint32_t column = 0; column < columns; ++column) {
        for (std::uint32_t row = 0; row < rows; ++row) {
            box.position =
                first + pitch * Vec2{static_cast<float>(column), static_cast<float>(row)};
            add(scene, box);
        }
    }
}

/// A piece of a ring about the origin between two radii, from one direction to another that is
/// less than half a turn further counter-clockwise.
ShapeDef ringPiece(float inner, float outer, double from, double to) {
    const auto at = [](float radius, double angle) {
        const RotationT<double> q = rotationOf(angle);
        return radius * Vec2{static_cast<float>(q.c), static_cast<float>(q.s)};
    };
    const std::array<Vec2, 4> corners{at(inner, from), at(outer, from), at(outer, to),
                                      at(inner, to)};
    return ShapeDef::polygon(corners);
}

}  // namespace

Scene pyramid(Values values) {
    const std::uint32_t base = count(values[0]);
    Scene scene;
    scene.sleep = false;
    const float half = 0.5f;
    const float ground = std::max(100.0f, half * static_cast<float>(base));  // half its width
    add(scene, bodyOf(BodyType::Static, {0.0f, -1.0f}, ShapeDef::box(ground, 1.0f)));
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
    scene.gravity.y *= static_cast<float>(values[1]);
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

Scene spinner(Values values) {
    const std::uint32_t bodies = count(values[0]);
    Scene scene;
    std::vector<Vec2> circle;
    for (int i = 0; i < 360; ++i) {  // clockwise: a room
        const RotationT<double> q = rotationOf(-2.0 * pi / 360.0 * i);
        circle.push_back({static_cast<float>(40.0 * q.c), static_cast<float>(40.0 * q.s + 32.0)});
    }
    BodyDef room;
    room.shapes = ShapeDef::chain(circle, true);
    for (ShapeDef& side : room.shapes) side.material.friction = 0.1f;
    const std::uint32_t ground = add(scene, room);

    const ShapeDef bar = ShapeDef::box(0.4f, 20.0f, {}, {}, 0.2f);
    BodyDef paddle = bodyOf(BodyType::Dynamic, {0.0f, 12.0f}, bar);
    paddle.maySleep = false;
    paddle.shapes[0].material.friction = 0.0f;
    // It would scrape the room, but jointed bodies do not touch each other.
    JointDef axle = hingeAt(scene, ground, ground, paddle.position);
    axle.bodyB = add(scene, paddle);
    axle.anchorB = {};
    axle.motor = {true, 5.0f, caps::maxEffort};
    scene.joints.push_back(axle);

    std::array<ShapeDef, 3> kinds{ShapeDef::capsule({-0.25f, 0.0f}, {0.25f, 0.0f}, 0.25f),
                                  ShapeDef::circle({}, 0.35f), ShapeDef::box(0.35f, 0.35f)};
    for (ShapeDef& kind : kinds) {
        kind.density = 0.25f;
        kind.material = {0.1f, 0.1f};
    }
    for (std::uint32_t i = 0; i < bodies; ++i) {
        const Vec2 place{static_cast<float>(i % 92), static_cast<float>(i / 92)};
        const Vec2 position = Vec2{-23.0f, 2.0f} + 0.5f * place;
        add(scene, bodyOf(BodyType::Dynamic, position, kinds[i % kinds.size()]));
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

Scene smash(Values values) {
    const std::uint32_t columns = count(values[0]);
    const std::uint32_t rows = count(values[1]);
    Scene scene;
    scene.gravity = {};
    BodyDef ram = bodyOf(BodyType::Dynamic, {-20.0f, 0.0f}, ShapeDef::box(4.0f, 4.0f));
    ram.velocity = {40.0f, 0.0f};
    ram.shapes[0].density = 8.0f;
    add(scene, ram);
    const float half = 0.2f;
    const float pitch = 2.0f * half;
    addGrid(scene, columns, rows, half, {30.0f, -0.5f * pitch * static_cast<float>(rows)}, pitch,
            true);
    fitLimits(scene);
    return scene;
}

Scene compounds(Values values) {
    const std::uint32_t columns = count(values[0]);
    const std::uint32_t rows = count(values[1]);
    Scene scene;
    std::vector<ShapeDef> ground;
    addTrough(ground, 40, 100);
    ground.push_back(ShapeDef::segment({-800.0f, -80.0f}, {800.0f, -80.0f}));
    addStatic(scene, ground);
    BodyDef body;
    body.type = BodyType::Dynamic;
    const std::array<Vec2, 3> left{Vec2{-1.0f, 0.0f}, Vec2{0.5f, 1.0f}, Vec2{0.0f, 2.0f}};
    const std::array<Vec2, 3> right{Vec2{1.0f, 0.0f}, Vec2{0.0f, 2.0f}, Vec2{-0.5f, 1.0f}};
    body.shapes = {ShapeDef::polygon(left), ShapeDef::polygon(right)};
    for (ShapeDef& triangle : body.shapes) triangle.material.friction = 0.5f;
    float side = 0.25f;  // every other body stands half a metre further left
    for (std::uint32_t column = 0; column < columns; ++column) {
        const float x = 2.0f * static_cast<float>(column) - (static_cast<float>(columns) - 1.0f);
        for (std::uint32_t row = 0; row < rows; ++row) {
            body.position = {x + side, 2.25f * static_cast<float>(row) + 5.575f};
            side = -side;
            add(scene, body);
        }
    }
    fitLimits(scene);
    return scene;
}

Scene washer(Values values) {
    const std::uint32_t side = count(values[0]);
    Scene scene;
    BodyDef ring;
    ring.type = BodyType::Kinematic;
    ring.position = {0.0f, 10.0f};
    ring.velocity = {0.001f, -0.002f};
    ring.angularVelocity = static_cast<float>(25.0 * pi / 180.0);
    const int pieces = 36;
    const double turn = 2.0 * pi / pieces;
    const double overlap = 0.1 * turn;  // on either side, so that no corner looks out of the ring
    for (int i = 0; i < pieces; ++i) {
        const double from = turn * i;
        ring.shapes.push_back(ringPiece(16.0f, 18.0f, from - overlap, from + turn + overlap));
        if (i % 9 == 0) ring.shapes.push_back(ringPiece(14.0f, 16.0f, from, from + turn));
    }
    add(scene, ring);
    const float half = 0.1f;
    const float low = -1.1f * half * static_cast<float>(side);
    addGrid(scene, side, side, half, {low, low + 10.0f}, 2.1f * half);
    fitLimits(scene);
    return scene;
}

}  // namespace huestep::scenes
