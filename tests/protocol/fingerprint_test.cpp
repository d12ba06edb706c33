#include "protocol/fingerprint.h"

#include <gtest/gtest.h>

#include "core/state/snapshot.h"
#include "protocol/scene_file.h"

namespace huestep::protocol {
namespace {

TEST(Fingerprint, ProseAndSpacingOfASchemaDoNotCount) {
    const std::uint64_t hash = schemaHash("struct A {\n  x @0 :UInt32;\n}\n");
    EXPECT_EQ(hash, schemaHash("struct A {  # what it is\n\n    x @0 :UInt32;  # m/s\n}\n"));
    EXPECT_NE(hash, schemaHash("struct A {\n  x @0 :UInt64;\n}\n"));
    EXPECT_NE(hash, schemaHash("struct A {\n  x @0 :UInt32;\n  y @1 :Bool;\n}\n"));
}

TEST(Fingerprint, OfThisBuildIsTheSameEachTimeAndLeavesTheSelfTestToItsCaller) {
    const Fingerprint fingerprint = buildFingerprint();
    EXPECT_EQ(fingerprint, buildFingerprint());
    EXPECT_NE(fingerprint.schema, schemaHash(""));
    EXPECT_EQ(fingerprint.scene & 0xffffu, sceneVersion);
    EXPECT_EQ(fingerprint.scene >> 16, snapshotVersion)
        << "an image of another layout cannot be taken over";
    EXPECT_EQ(fingerprint.selfTest, 0u);
}

}  // namespace
}  // namespace huestep::protocol
