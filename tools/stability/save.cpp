#include "tools/stability/save.h"

#include <algorithm>
#include <filesystem>
#include <memory>

#include "protocol/fingerprint.h"
#include "protocol/journal.h"
#include "protocol/log_store.h"
#include "protocol/scene_file.h"

namespace huestep::tools::stability {

namespace {

const std::string sceneFile = "scene.bin";
constexpr double playedOn = 1.0;  // s after it broke
constexpr std::size_t batchEntries = 4096;

/// A name that every file system takes: "row-04-heavy_top-ratio-400-n-5-seed-1-soft-step-4".
std::string folderName(const Setup& setup) {
    const std::string row = std::to_string(setup.trial.row);
    std::string name =
        "row-" + std::string(row.size() < 2 ? "0" : "") + row + "-" + setup.text + "-" +
        (isHuestep(setup.configuration)
             ? setup.configuration.method + "-" + std::to_string(setup.configuration.substeps)
             : setup.configuration.engine);
    for (char& c : name) {
        const bool plain =
            (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-' || c == '.';
        if (!plain) c = '-';
    }
    return name;
}

/// In a journal at most 64 of [a-z0-9_-].
std::string sessionName(const Setup& setup) {
    std::string name = "row-" + std::to_string(setup.trial.row) + "-" + setup.trial.scene;
    for (char& c : name) {
        const bool plain = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
        if (!plain) c = '-';
    }
    return name.substr(0, 64);
}

/// Writes what a world was and did, tick by tick.
class Recorder {
 public:
    Recorder(protocol::JournalWriter writer, std::uint64_t snapshotAt)
        : m_writer(std::move(writer)), m_snapshotAt(snapshotAt) {}

    /// A step that is about to lead from the world's tick.
    Status record(const World& world, const std::vector<Command>& commands) {
        if (world.tick() == 0 || world.tick() == m_snapshotAt) {
            const Status written = snapshot(world);
            if (!written) return written;
        }
        protocol::Frame frame;
        frame.tick = world.tick();
        frame.commands = commands;
        frame.previousRoot = world.motionRoot();
        m_batch.push_back({1, std::move(frame)});
        return m_batch.size() < batchEntries ? Status(Done{}) : flush();
    }

    Status finish(const World& world) {
        m_batch.push_back({1, protocol::FullRoot{world.tick(), world.fullRoot()}});
        return flush();
    }

 private:
    Status snapshot(const World& world) {
        if (const Status written = finish(world); !written) return written;
        const std::vector<std::byte> bytes = world.save();
        return m_writer.writeSnapshot(world.tick(), bytes);
    }

    Status flush() {
        const Status written = m_writer.append(m_batch);
        m_batch.clear();
        return written;
    }

    protocol::JournalWriter m_writer;
    std::uint64_t m_snapshotAt;
    std::vector<protocol::JournalEntry> m_batch;
};

Status writeJournal(protocol::LogStore& store, const Setup& setup, std::uint64_t snapshotAt,
                    std::uint64_t end) {
    const Result<protocol::Fingerprint> fingerprint = protocol::selfTest();
    if (!fingerprint) return fingerprint.error();
    const protocol::JournalIdentity identity{sessionName(setup), *fingerprint, 1};
    const Result<protocol::JournalContents> empty = protocol::readJournal(store);
    if (!empty) return empty.error();
    Result<protocol::JournalWriter> writer =
        protocol::JournalWriter::open(store, identity, *empty, 0);
    if (!writer) return writer.error();
    Recorder recorder(std::move(writer).value(), snapshotAt);
    Result<World> world = World::create(setup.scene);
    if (!world) return world.error();
    while (world->tick() < end) {
        const std::vector<Command> commands = setup.script.commands(world->tick());
        if (const Status recorded = recorder.record(*world, commands); !recorded) return recorded;
        world->step(commands);
    }
    return recorder.finish(*world);
}

}  // namespace

Status prepareFolder(const std::string& path) {
    std::error_code wrong;
    if (std::filesystem::exists(path, wrong)) {
        const bool folder = std::filesystem::is_directory(path, wrong);
        if (!folder || !std::filesystem::is_empty(path, wrong) || wrong)
            return Error{path + " is not an empty folder: failures are saved in a new one"};
        return Done{};
    }
    std::filesystem::create_directories(path, wrong);
    if (wrong) return Error{path + ": cannot be made: " + wrong.message()};
    return Done{};
}

Result<Saved> saveFailure(const std::string& parent, const Setup& setup,
                          const Judgement& judgement) {
    const std::string folder = parent + "/" + folderName(setup);
    Result<std::unique_ptr<protocol::LogStore>> store = protocol::openFolder(folder);
    if (!store) return store.error();
    const Status scene = (*store)->replace(sceneFile, protocol::writeSceneBinary(setup.scene));
    if (!scene) return scene.error();
    if (!isHuestep(setup.configuration))
        return Saved{folder, "huestep run " + folder + "/" + sceneFile + " --engine " +
                                 setup.configuration.engine + " --ticks " +
                                 std::to_string(setup.ticks)};
    const std::uint64_t broken = judgement.brokenAt.value_or(setup.ticks);
    const auto more =
        static_cast<std::uint64_t>(playedOn / static_cast<double>(setup.scene.stepSeconds) + 0.5);
    const std::uint64_t end = std::min(broken + more, setup.ticks);
    const std::uint64_t before = broken > 0 ? broken - 1 : 0;
    if (const Status written = writeJournal(**store, setup, before, end); !written)
        return Error{folder + ": " + written.error().message};
    return Saved{folder, "huestep replay " + folder + " --from " + std::to_string(before)};
}

std::string commandFor(const Setup& setup) {
    std::string command = "huestep run " + setup.text;
    const StabilityConfiguration& with = setup.configuration;
    if (!isHuestep(with))
        command += " --engine " + with.engine;
    else
        command += " --method " + with.method;
    if (isHuestep(with) && with.substeps != 0)
        command += " --substeps " + std::to_string(with.substeps);
    return command + " --ticks " + std::to_string(setup.ticks);
}

}  // namespace huestep::tools::stability
