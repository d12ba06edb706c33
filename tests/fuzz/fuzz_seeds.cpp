/// Writes the seeds of the fuzz targets: `fuzz_seeds tests/fuzz/corpus`.
#include <filesystem>
#include <fstream>

#include "protocol/frame.h"
#include "protocol/journal.h"
#include "protocol/memory_store.h"
#include "protocol/scene_file.h"
#include "tests/protocol/samples.h"

namespace {

using namespace huestep;
using namespace huestep::protocol;
namespace fs = std::filesystem;

void save(const fs::path& path, std::span<const std::byte> bytes) {
    fs::create_directories(path.parent_path());
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
}

std::span<const std::byte> bytesOf(const std::string& text) {
    return std::as_bytes(std::span(text.data(), text.size()));
}

/// A message's payload behind a word that names its type; gives back the whole frame.
std::vector<std::byte> savePayload(const fs::path& path, const Message& message) {
    auto frame = encode(message);
    std::vector<std::byte> payload(8);
    payload[0] = static_cast<std::byte>(typeOf(message));
    payload.insert(payload.end(), frame.begin() + headerBytes, frame.end());
    save(path, payload);
    return frame;
}

void saveFrames(const fs::path& folder) {
    std::vector<std::byte> stream;
    for (const Message& message : samples::sampleMessages()) {
        const std::string name = "payload-" + std::string(nameOf(typeOf(message)));
        const auto frame = savePayload(folder / name, message);
        stream.insert(stream.end(), frame.begin(), frame.end());
    }
    const Command target{0, 15, SetTarget{2, {1.0f, -2.0f}, {0.6f, 0.8f}}};
    savePayload(folder / "payload-Frame-SetTarget", Frame{601, {target}, {}, 1, 599});
    save(folder / "stream-of-all", stream);
    stream.resize(stream.size() - 5);
    save(folder / "stream-cut-short", stream);
}

void saveScenes(const fs::path& folder) {
    Scene scene;
    const Spawn spawn = samples::sampleSpawn();
    scene.name = "seed";
    scene.bodies = spawn.bodies;
    scene.joints = spawn.joints;
    scene.players.emplace();
    scene.players->spawnPoints = {{1.0f, 2.0f}};
    save(folder / "text", bytesOf(writeSceneJson(scene)));
    const auto binary = writeSceneBinary(scene);
    save(folder / "binary", binary);
    std::vector<std::byte> payload(8);
    payload[0] = std::byte{'B'};
    payload.insert(payload.end(), binary.begin() + 32, binary.end());
    save(folder / "binary-payload", payload);
    save(folder / "angle", bytesOf(R"({"version":1,"bodies":[{"rotation":{"angle":-1.5e0}}]})"));
    save(folder / "twice", bytesOf(R"({"version":1,"sleep":true,"sleep":false})"));
    save(folder / "overflow", bytesOf(R"({"version":1,"gravity":{"x":1e999,"y":-1e-99}})"));
    save(folder / "deep", bytesOf(R"({"version":1,"bodies":[[[[[[[[[[[[[[[[[]]]]]]]]]]]]]]]]]})"));
    save(folder / "unicode",
         bytesOf("{\"version\":1,\"name\":\"\\ud83c\\udfb2 \xe2\x82\xac\\u0000\"}"));
}

void saveJournals(const fs::path& folder) {
    MemoryStore store;
    auto writer = JournalWriter::open(store, {"seed", {1, 2, 3}, 1}, {}, 0);
    if (!writer) return;
    for (const Message& message : samples::sampleMessages()) {
        const auto* frame = std::get_if<Frame>(&message);
        if (frame == nullptr) continue;
        Frame first = *frame;
        first.tick = 0;
        const std::vector<JournalEntry> one{{1, first}};
        const std::vector<JournalEntry> two{{1, Frame{1, {}, {}, 5, 1}}, {1, FullRoot{2, 6}}};
        if (!writer->append(one) || !writer->append(two)) return;
    }
    if (!writer->writeSnapshot(0, std::vector<std::byte>(5'000, std::byte{9}))) return;
    auto segment = store.bytes("segment-000000000000.log");
    save(folder / "segment", segment);
    save(folder / "snapshot", store.bytes("snapshot-000000000000.snap"));
    segment.resize(segment.size() - 30);
    save(folder / "segment-torn", segment);
    std::fill(segment.begin() + 512, segment.begin() + 1'024, std::byte{0});
    save(folder / "segment-lost-block", segment);
    save(folder / "damage", bytesOf("\x01\x02\x04 \x02"));
}

/// Plain tickets, key files, addresses and texts, good ones and some that are cut short.
void saveDoor(const fs::path& folder) {
    const std::string key =
        "verifying d75a980182b10ab7d54bfed3c964073a0ee172f3daa62325af021a68f707511a\n";
    save(folder / "keys", bytesOf("huestep key 1\n# a host's\n" + key));
    save(folder / "keys-twice", bytesOf("huestep key 1\n" + key + key));
    save(folder / "keys-short", bytesOf("huestep key 1\nsealing 00ff\n"));
    std::string plain(36, '\0');
    plain[0] = 1;
    plain[11] = 1;  // expires 256 ms after it was issued, in 1970
    plain[34] = 4;
    plain[35] = 3;
    save(folder / "ticket", bytesOf(plain + "playann"));
    save(folder / "ticket-short", bytesOf(plain + "play"));
    save(folder / "ticket-other-version", bytesOf("\x02" + plain.substr(1) + "playann"));
    save(folder / "address-4", bytesOf("127.0.0.1:7777"));
    save(folder / "address-6", bytesOf("[2001:db8::1]:7777"));
    save(folder / "address-mapped", bytesOf("[::ffff:192.0.2.7]:0"));
    save(folder / "text", bytesOf("Zm9vYmFy_-"));
}

/// Lists of moves, see connection_target.cpp: what a client does in turn.
void saveConnections(const fs::path& folder) {
    constexpr char come = 0, hello = 4, frame = 8, raw = 12, ticks = 16, read = 20, wait = 24,
                   ask = 28;
    const auto moves = [&](const char* name, const std::string& bytes) {
        save(folder / name, bytesOf(bytes));
    };
    const auto framed = [&](const Message& message) {
        const auto bytes = encode(message);
        const std::size_t size = bytes.size() - headerBytes;
        std::string out{frame, static_cast<char>(size / 8), static_cast<char>(typeOf(message))};
        for (const std::byte b : std::span(bytes).subspan(headerBytes)) out += static_cast<char>(b);
        return out;
    };
    const std::string enter{come, hello, 0, ticks, 4, read, 0};
    moves("plays",
          enter + framed(Intent{{{1, 1, Release{}}}, {}}) + std::string{ticks, 9, read, 0});
    moves("watches", std::string{come, hello, 1, ticks, 4, read, 0, ticks, 30, read, 0});
    moves("asks",
          enter + std::string{ask, 2, 3, ticks, 40, read, 0, ask, 0, 1, ticks, 40, read, 0});
    moves("comes-back", enter + std::string{come, hello, 2, ticks, 4, read, 0});
    moves("does-not-read",
          enter + std::string{read, 127, ticks, 63, read, 127, ticks, 63, ticks, 63});
    moves("says-hello-twice", enter + std::string{hello, 0, ticks, 4});
    moves("stalls", std::string{come, raw, 3, 0x75, 0x48, 1, wait, 40, wait, 40});
    moves("is-silent", std::string{come, wait, 100, ticks, 4});
    moves("four-half-open", std::string{come, come + 1, come + 2, come + 3, ticks, 2});
    moves("leaves", enter + framed(Bye{ByeReason::Done, "leaves", false}) + std::string{ticks, 3});
    moves("speaks-as-server", enter + framed(Frame{}));
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) return 2;
    const fs::path folder = argv[1];
    saveFrames(folder / "frame");
    saveScenes(folder / "scene_file");
    saveJournals(folder / "journal");
    saveDoor(folder / "door");
    saveConnections(folder / "connection");
    return 0;
}
