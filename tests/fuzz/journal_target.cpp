/// Recovery of journals and snapshots.
///
/// The input is taken as a segment's file, as a snapshot's file, and as damage to a good journal:
/// groups of three bytes, each a place and what to XOR into it, and a last odd byte of which 64
/// times its value is cut off the end.
#include "protocol/journal.h"
#include "protocol/memory_store.h"
#include "tests/fuzz/target.h"

namespace {

using namespace huestep;
using namespace huestep::protocol;
using huestep::fuzz::require;

const std::string segment = "segment-000000000000.log";
const std::string snapshot = "snapshot-000000000000.snap";

/// Whatever is accepted can be continued, and reads back whole after it.
void recover(LogStore& store) {
    const auto contents = readJournal(store);
    if (!contents) {
        require(contents.error().message.find("memory/") == 0, "a refusal names its file");
        return;
    }
    JournalIdentity identity = contents->identity;
    if (identity.session.empty()) identity.session = "fuzz";
    auto writer = JournalWriter::open(store, identity, *contents, contents->nextTick);
    require(writer.ok(), "an accepted journal can be continued");
    const std::vector<JournalEntry> batch{{0, Frame{contents->nextTick, {}, {}, 1, 0}}};
    require(writer->append(batch).ok(), "a continued journal takes the next frame");
    const auto again = readJournal(store);
    require(again.ok(), "a continued journal reads back");
    require(again->tornBytes == 0, "a continued journal has no torn tail");
    require(again->nextTick == contents->nextTick + 1, "a continued journal goes on");
}

void recoverFile(const std::string& name, std::span<const std::byte> bytes) {
    MemoryStore store;
    require(store.replace(name, bytes).ok(), "a disk in memory works");
    recover(store);
}

/// Six frames in three batches, the same each time.
const std::vector<std::byte>& goodSegment() {
    static const std::vector<std::byte> bytes = [] {
        MemoryStore store;
        auto writer = JournalWriter::open(store, {"fuzz", {1, 2, 3}, 4}, {}, 0);
        for (std::uint64_t tick = 0; tick < 6; tick += 2) {
            const Command push{7, tick + 1, ApplyImpulse{3, {1.0f, 2.0f}, {}}};
            const std::vector<JournalEntry> batch{{4, Frame{tick, {push}, {}, tick, tick}},
                                                  {4, Frame{tick + 1, {}, {8}, tick, tick}},
                                                  {4, FullRoot{tick + 2, 99}}};
            require(writer->append(batch).ok(), "a disk in memory works");
        }
        return store.bytes(segment);
    }();
    return bytes;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto bytes = huestep::fuzz::bytesOf(data, size);
    recoverFile(segment, bytes);
    recoverFile(snapshot, bytes);
    std::vector<std::byte> damaged = goodSegment();
    for (std::size_t i = 0; i + 3 <= size; i += 3) {
        const std::size_t place = (data[i] * 256u + data[i + 1]) % damaged.size();
        damaged[place] ^= static_cast<std::byte>(data[i + 2]);
    }
    if (size % 3 != 0)
        damaged.resize(damaged.size() - std::min(damaged.size(), data[size - 1] * 64ul));
    recoverFile(segment, damaged);
    return 0;
}
