// The list of fields: it covers every record to the last byte, and names no field twice.

#include "core/state/records.h"

#include <cstring>
#include <iterator>
#include <set>

#include "core/state/delta.h"
#include "core/state/hash.h"
#include "core/state/snapshot.h"
#include "core/state/state.h"
#include "tests/core/support.h"

namespace huestep::test {
namespace {

TEST(Records, AreTiledByTheirFieldsWithoutGapOrOverlap) {
    WorldState state;
    std::size_t arrays = 0;
    forEachArray(state, [&](std::string_view name, const auto& array) {
        using Record = typename std::remove_cvref_t<decltype(array)>::value_type;
        ++arrays;
        std::vector<int> covered(sizeof(Record), 0);
        std::set<std::string> names;
        for (const Field& field : fieldsOf<Record>) {
            EXPECT_TRUE(names.insert(field.name).second) << name << " " << field.name;
            for (std::uint32_t k = 0; k < field.count * sizeOf(field.type); ++k) {
                ASSERT_LT(field.offset + k, sizeof(Record));
                ++covered[field.offset + k];
            }
        }
        for (std::size_t i = 0; i < covered.size(); ++i) EXPECT_EQ(covered[i], 1) << name << i;
        EXPECT_TRUE(std::is_trivially_copyable_v<Record>);
    });
    EXPECT_EQ(arrays, 14u);
}

/// What each version of snapshots holds, as a hash of the list of fields. One that was given away
/// once means the same for ever: a new layout gets a new line, and `snapshotVersion` and
/// `deltaVersion` its number.
constexpr std::pair<std::uint32_t, std::uint64_t> layouts[] = {
    {2, 0x271672d69a245cddu},
    {3, 0xee3344da9465750du},  // the same, and the two arrays of worlds with rules
};

/// The list of fields, as a hash.
std::uint64_t layoutOf(bool withRules) {
    const WorldState state;
    std::string text;
    forEachArray(state, [&](std::string_view name, const auto& array) {
        using Record = typename std::remove_cvref_t<decltype(array)>::value_type;
        if (isOfRules<Record> && !withRules) return;
        text += std::string(name) + " " + std::to_string(sizeof(Record)) + "\n";
        for (const Field& field : fieldsOf<Record>) {
            text += std::string("  ") + field.name;
            for (const std::uint32_t part :
                 {static_cast<std::uint32_t>(field.type), field.offset, field.count})
                text += " " + std::to_string(part);
            text += "\n";
        }
    });
    return hash64Of(std::span<const char>(text.data(), text.size()));
}

TEST(Records, HaveTheLayoutThatTheVersionOfSnapshotsSaysAndNoOther) {
    EXPECT_EQ(snapshotVersion, deltaVersion);
    EXPECT_EQ(rulesSnapshotVersion, rulesDeltaVersion);
    EXPECT_EQ(std::rbegin(layouts)->first, rulesSnapshotVersion);
    EXPECT_EQ(std::next(std::rbegin(layouts))->first, snapshotVersion);
    const std::uint64_t plain = layoutOf(false);
    const std::uint64_t withRules = layoutOf(true);
    EXPECT_EQ(std::next(std::rbegin(layouts))->second, plain)
        << std::hex << "the layout is now 0x" << plain << ": a version of its own";
    EXPECT_EQ(std::rbegin(layouts)->second, withRules)
        << std::hex << "the layout is now 0x" << withRules << ": a version of its own";
}

TEST(Records, StayWithinTheBytesThatTheDesignAllows) {
    EXPECT_LE(sizeof(BodyMotion), 64u) << "a body, definitions apart";
    EXPECT_LE(sizeof(ContactState), 48u) << "a touching contact";
    EXPECT_LE(sizeof(JointImpulses), 32u) << "a joint, definitions apart";
}

TEST(Records, FieldsStandWhereTheirMembersAre) {
    BodyMotion m{};
    m.angularVelocity = 3.5f;
    m.rest = 17;
    const auto* bytes = reinterpret_cast<const char*>(&m);
    for (const Field& field : fieldsOf<BodyMotion>) {
        float f;
        std::uint32_t u;
        std::memcpy(&f, bytes + field.offset, 4);
        std::memcpy(&u, bytes + field.offset, 4);
        if (std::string(field.name) == "angularVelocity") {
            EXPECT_EQ(f, 3.5f);
        }
        if (std::string(field.name) == "rest") {
            EXPECT_EQ(u, 17u);
        }
    }
    EXPECT_FALSE(m.asleep());
    m.rest |= BodyMotion::asleepBit;
    EXPECT_TRUE(m.asleep());
}

}  // namespace
}  // namespace huestep::test
