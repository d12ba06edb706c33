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

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) return 2;
    const fs::path folder = argv[1];
    saveFrames(folder / "frame");
    saveScenes(folder / "scene_file");
    saveJournals(folder / "journal");
    return 0;
}
