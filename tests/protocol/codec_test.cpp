#include "protocol/codec.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>

#include "protocol/frame.h"
#include "tests/protocol/samples.h"

namespace huestep::protocol {
namespace {

using samples::Draw;
using samples::reasonOf;

constexpr std::uint64_t seed = 20'240'611;

/// What a peer says to the message.
std::string answerTo(const Message& message) {
    return reasonOf(readFrame(encode(message)));
}

/// Tests/protocol/corpus/TYPE-N.bin: the sample as the N-th form of the schema wrote it.
std::filesystem::path corpusFile(MessageType type, int form) {
    return std::filesystem::path(HUESTEP_SOURCE_DIR) / "tests/protocol/corpus" /
           (std::string(nameOf(type)) + "-" + std::to_string(form) + ".bin");
}

int formsOf(MessageType type) {
    int forms = 0;
    while (std::filesystem::exists(corpusFile(type, forms + 1))) ++forms;
    return forms;
}

std::vector<std::byte> readAll(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    const std::string text((std::istreambuf_iterator<char>(file)), {});
    const auto bytes = std::as_bytes(std::span(text.data(), text.size()));
    return {bytes.begin(), bytes.end()};
}

TEST(Codec, EveryMessageComesBackAsItWas) {
    std::printf("seed %llu\n", static_cast<unsigned long long>(seed));
    Draw draw(seed);
    for (int round = 0; round < 300; ++round) {
        for (std::size_t i = 0; i < samples::messageTypes; ++i) {
            const Message message = samples::randomMessage(draw, static_cast<MessageType>(i));
            ASSERT_EQ(message.index(), i);
            const Result<Message> back = readFrame(encode(message));
            ASSERT_TRUE(back.ok()) << reasonOf(back);
            ASSERT_EQ(*back, message) << nameOf(static_cast<MessageType>(i)) << ", round " << round;
        }
    }
}

TEST(Codec, EveryActionComesBackAsItWas) {
    Draw draw(seed + 1);
    for (std::size_t kind = 0; kind < samples::actionKinds; ++kind) {
        for (int round = 0; round < 50; ++round) {
            const Frame frame{1, {{3, 4, samples::randomAction(draw, kind)}}, {}, 5, 6};
            const Result<Message> back = readFrame(encode(frame));
            ASSERT_TRUE(back.ok()) << reasonOf(back);
            ASSERT_EQ(std::get<Frame>(*back), frame) << "action " << kind;
        }
    }
}

TEST(Codec, DefaultMessagesOfEveryTypeHaveASizeKnownBeforehand) {
    // A message without lists and texts: header, root pointer and the root struct. The numbers are
    // from the schema by hand; a field that does not grow the struct's last word changes nothing.
    EXPECT_EQ(encode(Ping{}).size(), 16u + 8 + 24);
    EXPECT_EQ(encode(SnapshotEnd{}).size(), 16u + 8 + 8);
    EXPECT_EQ(encode(SnapshotBegin{}).size(), 16u + 8 + 24);
    EXPECT_EQ(encode(Frame{}).size(), 16u + 8 + 40);
    EXPECT_EQ(encode(Intent{}).size(), 16u + 8 + 40);
}

TEST(Codec, BytesOfOldMessagesStillMeanTheSame) {
    const auto messages = samples::sampleMessages();
    ASSERT_EQ(messages.size(), samples::messageTypes);
    for (const Message& message : messages) {
        const int forms = formsOf(typeOf(message));
        for (int form = 1; form <= forms; ++form) {
            const auto path = corpusFile(typeOf(message), form);
            const Result<Message> decoded = readFrame(readAll(path));
            ASSERT_TRUE(decoded.ok()) << path << ": " << reasonOf(decoded);
            EXPECT_EQ(*decoded, message) << path;
        }
    }
}

TEST(Codec, BytesOfTheNewestFormAreWhatIsWrittenToday) {
    for (const Message& message : samples::sampleMessages()) {
        const int forms = formsOf(typeOf(message));
        const auto newest = readAll(corpusFile(typeOf(message), forms));
        const auto bytes = encode(message);
        if (std::getenv("HUESTEP_MINT_CORPUS") != nullptr && newest != bytes) {
            std::ofstream(corpusFile(typeOf(message), forms + 1), std::ios::binary)
                .write(reinterpret_cast<const char*>(bytes.data()),
                       static_cast<std::streamsize>(bytes.size()));
        }
        EXPECT_EQ(newest, bytes) << nameOf(typeOf(message))
                                 << ": if the schema grew, HUESTEP_MINT_CORPUS=1 adds its new form";
    }
}

TEST(Codec, ABitFlippedInAPayloadIsRefusedOrDecodedButNeverCrashes) {
    // Below the checksum, so that the decoder itself meets every one-bit error.
    std::size_t refused = 0;
    std::size_t decodedCount = 0;
    for (const Message& message : samples::sampleMessages()) {
        const auto frame = encode(message);
        std::vector<std::byte> payload(frame.begin() + headerBytes, frame.end());
        for (std::size_t bit = 0; bit < 8 * payload.size(); ++bit) {
            const auto mask = static_cast<std::byte>(1u << (bit % 8));
            payload[bit / 8] ^= mask;
            const Result<Message> result = decode(typeOf(message), payload);
            if (result.ok()) {
                ++decodedCount;
                // What was accepted is within the limits: it survives another round trip.
                ASSERT_EQ(answerTo(*result), "accepted");
            } else {
                ++refused;
                ASSERT_EQ(result.error().message.rfind(nameOf(typeOf(message)), 0), 0u)
                    << result.error().message;
            }
            payload[bit / 8] ^= mask;
        }
    }
    EXPECT_GT(refused, 100u);
    EXPECT_GT(decodedCount, 100u);
}

TEST(Codec, RandomWordsAreRefusedOrDecodedButNeverCrash) {
    Draw draw(seed + 2);
    std::printf("seed %llu\n", static_cast<unsigned long long>(seed + 2));
    for (int round = 0; round < 20'000; ++round) {
        const auto type = static_cast<MessageType>(draw.below(samples::messageTypes));
        std::vector<std::byte> payload(8 * (1 + draw.below(40)));
        for (auto& byte : payload) {
            // Small bytes make pointers that stay inside the message more often.
            byte = static_cast<std::byte>(draw.below(draw.below(4) == 0 ? 256 : 8));
        }
        const Result<Message> result = decode(type, payload);
        if (!result.ok()) continue;
        ASSERT_EQ(answerTo(*result), "accepted");
    }
}

TEST(Codec, CutShortMessagesAreRefusedOrReadWithDefaults) {
    for (const Message& message : samples::sampleMessages()) {
        const auto frame = encode(message);
        const auto payload = std::span(frame).subspan(headerBytes);
        for (std::size_t size = 0; size < payload.size(); ++size) {
            const Result<Message> result = decode(typeOf(message), payload.first(size));
            ASSERT_FALSE(result.ok()) << nameOf(typeOf(message)) << " of " << size << " bytes";
        }
    }
}

TEST(Codec, PayloadsNeedNotBeAligned) {
    for (const Message& message : samples::sampleMessages()) {
        const auto frame = encode(message);
        for (std::size_t shift = 1; shift < 8; ++shift) {
            std::vector<std::byte> moved(shift);
            moved.insert(moved.end(), frame.begin(), frame.end());
            const Result<Message> back = readFrame(std::span(moved).subspan(shift));
            ASSERT_TRUE(back.ok()) << reasonOf(back);
            ASSERT_EQ(*back, message);
        }
    }
}

TEST(Codec, FarPointersToOtherSegmentsAreRefused) {
    // A root pointer of kind 2 (far) into segment 1: there is exactly one segment.
    std::vector<std::byte> payload(16);
    const std::uint64_t far = 2u | (std::uint64_t{1} << 32);
    std::memcpy(payload.data(), &far, 8);
    const Result<Message> result = decode(MessageType::Ping, payload);
    ASSERT_FALSE(result.ok());
    EXPECT_EQ(result.error().message.rfind("Ping: not well-formed (", 0), 0u)
        << result.error().message;
}

TEST(Codec, AListThatClaimsMoreThanTheMessageHoldsIsRefused) {
    // Frame with a `commands` list of 2^29 − 1 structs of zero words: one tag word on the wire.
    std::vector<std::uint64_t> words(9);
    const auto structPointer = [](std::uint64_t offset, std::uint64_t data,
                                  std::uint64_t pointers) {
        return offset << 2 | data << 32 | pointers << 48;
    };
    words[0] = structPointer(0, 3, 2);
    words[4] =
        1u | (1u << 2) | (std::uint64_t{7} << 32);  // list at word 6, inline composite, 0 words
    words[6] = std::uint64_t{(1u << 29) - 1} << 2;  // tag: that many structs of no words
    const Result<Message> result = decode(MessageType::Frame, std::as_bytes(std::span(words)));
    ASSERT_FALSE(result.ok());
    words[6] = std::uint64_t{4'096} << 2;  // within the limit, but far more than 72 bytes can say
    const Result<Message> fewer = decode(MessageType::Frame, std::as_bytes(std::span(words)));
    ASSERT_FALSE(fewer.ok());
}

TEST(Codec, ListsThatOverlapCannotMakeMoreThanTheirBytesAreWorth) {
    // 64 spawns that all point at the same list of bodies: each is honest alone.
    BodyDef body;
    std::vector<Command> commands(maxCommandsPerIntent);
    for (auto& command : commands) command.action = Spawn{};
    std::get<Spawn>(commands[0].action).bodies.assign(50, body);
    auto frame = encode(Intent{commands, {}});
    auto payload = std::vector<std::byte>(frame.begin() + headerBytes, frame.end());
    ASSERT_TRUE(decode(MessageType::Intent, payload).ok());
    // Commands follow the root (1 + 5 words) and the list's tag; a command is 6 words, its spawn
    // pointer the last. Point every spawn at the first one's struct.
    const auto pointerAt = [&](std::size_t command) { return 8 * (7 + 6 * command + 5); };
    std::uint64_t first = 0;
    std::memcpy(&first, payload.data() + pointerAt(0), 8);
    ASSERT_EQ(first >> 48, 2u) << "not the spawn's struct pointer";
    const auto target = static_cast<std::int64_t>(pointerAt(0) / 8 + 1) +
                        static_cast<std::int64_t>((first & 0xffffffffu) >> 2);
    for (std::size_t i = 1; i < commands.size(); ++i) {
        const std::int64_t offset = target - static_cast<std::int64_t>(pointerAt(i) / 8 + 1);
        const std::uint64_t pointer =
            (first & ~std::uint64_t{0xffffffffu}) |
            static_cast<std::uint64_t>(static_cast<std::uint32_t>(offset * 4));
        std::memcpy(payload.data() + pointerAt(i), &pointer, 8);
    }
    const Result<Message> result = decode(MessageType::Intent, payload);
    ASSERT_FALSE(result.ok());
}

TEST(Codec, StructsCutShortCannotMakeMoreThanTheirBytesAreWorth) {
    // Commands of one word each, as no form of the schema ever had them, would grow to many times
    // their bytes in memory.
    constexpr std::uint64_t count = 4'000;
    std::vector<std::uint64_t> words(7 + count);
    words[0] = std::uint64_t{3} << 32 | std::uint64_t{2} << 48;        // root: 3 words, 2 pointers
    words[4] = 1u | (1u << 2) | std::uint64_t{7} << 32 | count << 35;  // list at word 6, composite
    words[6] = count << 2 | std::uint64_t{1} << 32;                    // tag: one word each
    EXPECT_EQ(reasonOf(decode(MessageType::Frame, std::as_bytes(std::span(words)))),
              "Frame.commands: more values than the message has bytes for");
}

// ---- limits: the last value allowed is accepted, the next is refused by name --------------------

TEST(CodecLimits, SessionNames) {
    Hello hello;
    for (const char* good : {"a", "0", "_-", "sandbox-2"}) {
        hello.session = good;
        EXPECT_EQ(answerTo(hello), "accepted") << good;
    }
    hello.session = std::string(64, 'x');
    EXPECT_EQ(answerTo(hello), "accepted");
    const std::string refusal = "Hello.session: not a name of 1 to 64 of a-z, 0-9, _ and -";
    for (const std::string& bad : {std::string(), std::string(65, 'x'), std::string("A"),
                                   std::string("a/b"), std::string(".."), std::string("a\0b", 3)}) {
        hello.session = bad;
        EXPECT_EQ(answerTo(hello), refusal) << bad;
    }
}

TEST(CodecLimits, WelcomeRanges) {
    Welcome good;
    good.session = "s";
    EXPECT_EQ(answerTo(good), "accepted");
    Welcome bad = good;
    bad.ticksPerSecond = 0.0f;
    EXPECT_EQ(answerTo(bad), "Welcome.ticksPerSecond: not above 0 and at most 10000");
    bad.ticksPerSecond = 10000.5f;
    EXPECT_EQ(answerTo(bad), "Welcome.ticksPerSecond: not above 0 and at most 10000");
    bad.ticksPerSecond = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(answerTo(bad), "Welcome.ticksPerSecond: not a finite number");
    bad = good;
    bad.inputDelay = maxInputDelay + 1;
    EXPECT_EQ(answerTo(bad), "Welcome.inputDelay: 601 is above 600");
    bad = good;
    bad.maxInputDelay = maxInputDelay + 1;
    EXPECT_EQ(answerTo(bad), "Welcome.maxInputDelay: 601 is above 600");
    bad = good;
    bad.maxCommandsPerIntent = 0;
    EXPECT_EQ(answerTo(bad), "Welcome.maxCommandsPerIntent: 0 is below 1");
    bad.maxCommandsPerIntent = maxCommandsPerIntent + 1;
    EXPECT_EQ(answerTo(bad), "Welcome.maxCommandsPerIntent: 65 is above 64");
    bad = good;
    bad.maxQueuedCommands = 0;
    EXPECT_EQ(answerTo(bad), "Welcome.maxQueuedCommands: 0 is below 1");
    bad.maxQueuedCommands = maxQueuedCommands + 1;
    EXPECT_EQ(answerTo(bad), "Welcome.maxQueuedCommands: 65537 is above 65536");
    bad = good;
    bad.maxQueuedBytes = minQueuedBytes - 1;
    EXPECT_EQ(answerTo(bad), "Welcome.maxQueuedBytes: 16383 is below 16384");
    bad.maxQueuedBytes = maxQueuedBytes + 1;
    EXPECT_EQ(answerTo(bad), "Welcome.maxQueuedBytes: 16777217 is above 16777216");
}

TEST(CodecLimits, CommandsAnIntentAndAFrame) {
    Intent intent;
    intent.commands.resize(maxCommandsPerIntent);
    EXPECT_EQ(answerTo(intent), "accepted");
    intent.commands.emplace_back();
    EXPECT_EQ(answerTo(intent), "Intent.commands: 65 entries, at most 64");
    Frame frame;
    frame.commands.resize(maxCommandsPerFrame);
    frame.substituted.resize(maxSubstituted);
    EXPECT_EQ(answerTo(frame), "accepted");
    frame.commands.emplace_back();
    EXPECT_EQ(answerTo(frame), "Frame.commands: 4097 entries, at most 4096");
    frame.commands.clear();
    frame.substituted.emplace_back();
    EXPECT_EQ(answerTo(frame), "Frame.substituted: 4097 entries, at most 4096");
}

TEST(CodecLimits, SpawnedBodiesShapesAndJoints) {
    Frame frame;
    const auto with = [&](std::size_t bodies, std::size_t shapes, std::size_t joints) {
        Spawn spawn;
        spawn.bodies.resize(bodies);
        if (bodies > 0) spawn.bodies.back().shapes.resize(shapes);
        spawn.joints.resize(joints);
        frame.commands = {{0, 1, spawn}};
        return answerTo(frame);
    };
    EXPECT_EQ(with(maxSpawnBodies, 0, maxSpawnJoints), "accepted");
    EXPECT_EQ(with(1, maxShapesPerBody, 0), "accepted");
    EXPECT_EQ(with(1025, 0, 0), "Frame.commands[0].spawn.bodies: 1025 entries, at most 1024");
    EXPECT_EQ(with(0, 0, 1025), "Frame.commands[0].spawn.joints: 1025 entries, at most 1024");
    EXPECT_EQ(with(2, 1025, 0),
              "Frame.commands[0].spawn.bodies[1].shapes: 1025 entries, at most 1024");
    Spawn spawn;
    spawn.bodies.resize(1);
    spawn.bodies[0].shapes.resize(1);
    spawn.bodies[0].shapes[0].vertexCount = maxPolygonVertices;
    frame.commands = {{0, 1, spawn}};
    EXPECT_EQ(answerTo(frame), "accepted");
}

TEST(CodecLimits, TheLargestSpawnThatAWorldTakesOfAPlayerFitsAnIntent) {
    ShapeDef shape;
    shape.kind = ShapeKind::Polygon;
    shape.vertexCount = maxPolygonVertices;
    BodyDef body;
    body.shapes.assign(8, shape);
    const Command command{7, 1, Spawn{std::vector<BodyDef>(8, body), {}}};
    EXPECT_EQ(answerTo(Intent{{command}, Checkpoint{}}), "accepted");
    EXPECT_LE(commandBytes(command), minQueuedBytes);
}

TEST(CodecLimits, NumbersMustBeFinite) {
    const float infinity = std::numeric_limits<float>::infinity();
    Frame frame;
    frame.commands = {{}, {0, 1, ApplyImpulse{1, {0.0f, infinity}, {}}}};
    EXPECT_EQ(answerTo(frame), "Frame.commands[1].applyImpulse.impulse.y: not a finite number");
    Spawn spawn = samples::sampleSpawn();
    spawn.bodies[0].shapes[0].vertices[2].x = -infinity;
    frame.commands = {{0, 1, spawn}};
    EXPECT_EQ(answerTo(frame),
              "Frame.commands[0].spawn.bodies[0].shapes[0].vertices[2].x: not a finite number");
    spawn = samples::sampleSpawn();
    spawn.joints[0].limit.upper = std::numeric_limits<float>::quiet_NaN();
    frame.commands = {{0, 1, spawn}};
    EXPECT_EQ(answerTo(frame),
              "Frame.commands[0].spawn.joints[0].limit.upper: not a finite number");
    frame.commands = {{0, 1, SetVelocity{1, {}, infinity}}};
    EXPECT_EQ(answerTo(frame),
              "Frame.commands[0].setVelocity.angularVelocity: not a finite number");
    frame.commands = {{0, 1, SetTarget{1, {infinity, 0.0f}, {}}}};
    EXPECT_EQ(answerTo(frame), "Frame.commands[0].setTarget.position.x: not a finite number");
    frame.commands = {{0, 1, SetTarget{1, {}, {1.0f, -infinity}}}};
    EXPECT_EQ(answerTo(frame), "Frame.commands[0].setTarget.rotation.s: not a finite number");
    View view;
    view.poses.resize(2);
    view.flags.resize(2);
    view.poses[1].q.s = infinity;
    EXPECT_EQ(answerTo(view), "View.poses[1].s: not a finite number");
}

TEST(CodecLimits, Tickets) {
    Hello hello;
    hello.session = "s";
    hello.ticket.resize(maxTicketBytes);
    EXPECT_EQ(answerTo(hello), "accepted");
    hello.ticket.resize(maxTicketBytes + 1);
    EXPECT_EQ(answerTo(hello), "Hello.ticket: 257 entries, at most 256");
}

TEST(CodecLimits, ValuesBeyondAnEnumAreRefused) {
    Hello hello;
    hello.session = "s";
    hello.role = static_cast<Role>(2);
    EXPECT_EQ(answerTo(hello), "Hello.role: unknown value 2");
    Bye bye;
    bye.reason = static_cast<ByeReason>(13);
    EXPECT_EQ(answerTo(bye), "Bye.reason: unknown value 13");
    Spawn spawn = samples::sampleSpawn();
    spawn.bodies[1].type = static_cast<BodyType>(3);
    EXPECT_EQ(answerTo(Frame{0, {{0, 1, spawn}}, {}, 0, 0}),
              "Frame.commands[0].spawn.bodies[1].type: unknown value 3");
    spawn = samples::sampleSpawn();
    spawn.bodies[1].shapes[0].kind = static_cast<ShapeKind>(5);
    EXPECT_EQ(answerTo(Frame{0, {{0, 1, spawn}}, {}, 0, 0}),
              "Frame.commands[0].spawn.bodies[1].shapes[0].kind: unknown value 5");
    spawn = samples::sampleSpawn();
    spawn.joints[0].kind = static_cast<JointKind>(5);
    EXPECT_EQ(answerTo(Frame{0, {{0, 1, spawn}}, {}, 0, 0}),
              "Frame.commands[0].spawn.joints[0].kind: unknown value 5");
}

TEST(CodecLimits, AnUnknownActionIsRefused) {
    auto frame = encode(Frame{0, {{0, 1, Release{}}}, {}, 0, 0});
    std::vector<std::byte> payload(frame.begin() + headerBytes, frame.end());
    // The discriminant of `action` is at byte 16 of the command, which
    // follows root pointer, root struct (5 words) and the list's tag.
    payload[8 * 7 + 16] = std::byte{14};
    EXPECT_EQ(reasonOf(decode(MessageType::Frame, payload)),
              "Frame.commands[0]: unknown action 14");
}

TEST(CodecLimits, Texts) {
    Bye bye{ByeReason::Done, std::string(maxByeText, 'x'), false};
    EXPECT_EQ(answerTo(bye), "accepted");
    bye.text += 'x';
    EXPECT_EQ(answerTo(bye), "Bye.text: 257 bytes, at most 256");
    const std::string refusal = "Bye.text: not UTF-8 text without control characters";
    for (const std::string& bad :
         {std::string("a\nb"), std::string("a\0b", 3), std::string("\x1b[2J"), std::string("\x7f"),
          std::string("\xff"), std::string("\xc3"), std::string("\xc0\x80"),
          std::string("\xed\xa0\x80"), std::string("\xf4\x90\x80\x80")}) {
        bye.text = bad;
        EXPECT_EQ(answerTo(bye), refusal);
    }
    bye.text = "\xe2\x82\xac \xf0\x9f\x8e\xb2 \xc3\xa9";
    EXPECT_EQ(answerTo(bye), "accepted");
    DesyncReport report;
    report.here = std::string(maxReportText + 1, 'x');
    EXPECT_EQ(answerTo(report), "DesyncReport.here: 129 bytes, at most 128");
    report = {};
    report.there = report.field = std::string(maxReportText + 1, 'x');
    EXPECT_EQ(answerTo(report), "DesyncReport.field: 129 bytes, at most 128");
    report.field.clear();
    EXPECT_EQ(answerTo(report), "DesyncReport.there: 129 bytes, at most 128");
}

TEST(CodecLimits, SnapshotsAndHashes) {
    EXPECT_EQ(answerTo(SnapshotBegin{1, maxSnapshotBytes, 0}), "accepted");
    EXPECT_EQ(answerTo(SnapshotBegin{1, maxSnapshotBytes + 1, 0}),
              "SnapshotBegin.bytes: 268435457 is above 268435456");
    SnapshotChunk chunk{maxSnapshotBytes, std::vector<std::byte>(maxChunkBytes)};
    EXPECT_EQ(answerTo(chunk), "accepted");
    chunk.data.emplace_back();
    EXPECT_EQ(answerTo(chunk), "SnapshotChunk.data: 60001 entries, at most 60000");
    EXPECT_EQ(answerTo(SnapshotChunk{maxSnapshotBytes + 1, {}}),
              "SnapshotChunk.offset: 268435457 is above 268435456");
    HashNodes nodes{1, std::vector<std::uint64_t>(maxLeaves, 7), 0};
    EXPECT_EQ(answerTo(nodes), "accepted");
    nodes.leaves.push_back(7);
    EXPECT_EQ(answerTo(nodes), "HashNodes.leaves: 4097 entries, at most 4096");
}

TEST(CodecLimits, Views) {
    View view;
    view.poses.resize(3);
    view.flags.resize(2);
    EXPECT_EQ(answerTo(view), "View.flags: not one byte a body");
    view.flags.resize(3);
    view.bodies.resize(2);
    EXPECT_EQ(answerTo(view), "View.bodies: not one id a body");
    view.bodies.resize(3);
    view.shapes = {{3, ShapeKind::Circle, 1.0f, {{}}}};
    EXPECT_EQ(answerTo(view), "View.shapes[0].body: no such body");
    view.shapes = {{2, ShapeKind::Circle, 1.0f, {}}};
    EXPECT_EQ(answerTo(view), "View.shapes[0].vertexCount: 0 do not fit");
    view.shapes = {{2, ShapeKind::Polygon, 1.0f, std::vector<Vec2>(9)}};
    EXPECT_EQ(answerTo(view), "View.shapes[0].vertexCount: 9 do not fit");
    view.shapes.clear();
    view.contacts.resize(maxViewContacts + 1);
    EXPECT_EQ(answerTo(view), "View.contacts: 262145 entries, at most 262144");
    view = {};
    view.joints.resize(maxViewJoints + 1);
    EXPECT_EQ(answerTo(view), "View.joints: 524292 entries, at most 524288");
    view = {};
    view.poses.resize(maxViewBodies + 1);
    view.flags.resize(maxViewBodies + 1);
    EXPECT_EQ(answerTo(view), "View.poses: 524292 entries, at most 524288");
}

TEST(CodecLimits, TheLargestViewFits) {
    View view;
    view.poses.resize(maxViewBodies);
    view.flags.resize(maxViewBodies);
    view.bodies.resize(maxViewBodies);
    view.contacts.resize(maxViewContacts);
    view.joints.resize(maxViewJoints);
    view.shapes.assign(maxViewShapes, {0, ShapeKind::Polygon, 1.0f, std::vector<Vec2>(8)});
    EXPECT_EQ(answerTo(view), "accepted");
}

TEST(CodecLimits, PayloadsLongerThanTheirTypeAllowsAreRefused) {
    for (std::size_t i = 0; i < samples::messageTypes; ++i) {
        const auto type = static_cast<MessageType>(i);
        const std::vector<std::byte> payload(maxPayload(type) + 8);
        const std::string expected = std::string(nameOf(type)) + ": " +
                                     std::to_string(payload.size()) + " bytes, at most " +
                                     std::to_string(maxPayload(type));
        EXPECT_EQ(reasonOf(decode(type, payload)), expected);
    }
    EXPECT_EQ(maxPayload(MessageType::Hello), 1024u);
    EXPECT_EQ(maxPayload(MessageType::Count), 0u);
    EXPECT_EQ(reasonOf(decode(MessageType::Count, {})), "message type 14 is unknown");
}

TEST(CodecLimits, CommandBytesBoundTheFrame) {
    Draw draw(seed + 3);
    for (int round = 0; round < 200; ++round) {
        Frame frame;
        frame.commands = samples::randomCommands(draw, 10);
        frame.substituted.resize(draw.below(9));
        std::size_t bytes = frameBytes + 4 * frame.substituted.size();
        for (const Command& command : frame.commands) bytes += commandBytes(command);
        const std::size_t payload = encode(frame).size() - headerBytes;
        EXPECT_LE(payload, (bytes + 7) / 8 * 8);
        EXPECT_GE(payload + 16, bytes) << "the bound is loose";
    }
}

}  // namespace
}  // namespace huestep::protocol
