// Bounds of hulls: the form in lanes gives the numbers of the general one.

#include "core/collision/hull.h"

#include "core/math/trig.h"
#include "tests/core/hulls.h"

namespace huestep::test {
namespace {

TEST(Hull, BoundsInLanesAreThoseOfEveryVertex) {
    Random random(88);
    SCOPED_TRACE(random.trace());
    for (int trial = 0; trial < 50'000; ++trial) {
        const Hull hull = hullOfDef<float>(randomShapeDef(random));
        const Pose pose{random.point(-1000.0, 1000.0), rotationOf(random.betweenF(-3.1, 3.1))};
        Vec2 low = transform(pose, hull.vertices[0]), high = low;
        for (std::size_t i = 1; i < static_cast<std::size_t>(hull.count); ++i) {
            low = minOf(low, transform(pose, hull.vertices[i]));
            high = maxOf(high, transform(pose, hull.vertices[i]));
        }
        ASSERT_EQ(boundsOf(hull, pose), grown(Bounds{low, high}, hull.radius)) << trial;
    }
}

}  // namespace
}  // namespace huestep::test
