/// `huestep chart`: speed against accuracy, stability, and what colouring is worth, as one page,
/// pictures and tables.
#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <utility>

#include "tools/chart/csv.h"
#include "tools/chart/document.h"
#include "tools/chart/page.h"
#include "tools/chart/stability.h"
#include "tools/clock.h"
#include "tools/command.h"
#include "tools/files.h"
#include "tools/interrupt.h"
#include "tools/machine.h"
#include "tools/progress.h"

namespace huestep::tools {
namespace {

using chart::Extent;
using chart::Findings;

struct Options {
    std::string folder;
    std::string stability;  // a file
    bool quick = false;
    bool smoke = false;
    bool json = false;

    [[nodiscard]] Extent extent() const {
        return smoke ? Extent::Smoke : quick ? Extent::Quick : Extent::Full;
    }
};

/// Says what is being done, how far the whole is, and how long it took once it is done.
class Part {
 public:
    Part(const char* name, std::size_t number, std::size_t of) : m_name(name) {
        std::fprintf(stderr, "%s: part %zu of %zu ...\n", m_name, number, of);
    }
    void done() const {
        const double seconds = static_cast<double>(nanoseconds() - m_begin) * 1e-9;
        std::fprintf(stderr, "%s: done in %.0f s\n", m_name, seconds);
    }

 private:
    const char* m_name;
    std::uint64_t m_begin = nanoseconds();
};

Result<bool> measureWork(Findings& f) {
    f.cases = chart::workCases(f.extent);
    const std::vector<chart::Contender> contenders =
        chart::allContenders(chart::workSubsteps(f.extent));
    Progress progress("errors and times", f.cases.size());
    for (const chart::Case& one : f.cases) {
        const Result<bool> done = chart::measureCase(one, contenders, f.extent, f.points);
        if (!done || !*done) return done;
        progress.advance();
    }
    return true;
}

/// Unless a file has said it.
Result<bool> stabilityOf(Findings& f) {
    if (!f.stability.empty()) return true;
    return chart::measureStability(f.extent, f.stability);
}

/// The parts, each of which leaves what it found behind. False: interrupted.
Result<bool> measureAll(Findings& f) {
    struct Piece {
        const char* name;
        std::function<Result<bool>()> measure;
    };
    const Piece pieces[] = {
        {"work-precision", [&f] { return measureWork(f); }},
        {"sizes", [&f] { return chart::measureSizes(f.extent, f.sizes); }},
        {"scenes", [&f] { return chart::measureScenes(f.extent, f.scenes); }},
        {"prices of sharing", [&f] { return chart::measurePrices(f.extent, f.prices); }},
        {"effort by need", [&f] { return chart::measureEffort(f.extent, f.effort); }},
        {"stability", [&f] { return stabilityOf(f); }}};
    std::size_t begun = 0;
    for (const Piece& piece : pieces) {
        const Part part(piece.name, ++begun, std::size(pieces));
        const Result<bool> done = piece.measure();
        if (!done || !*done) return done;
        part.done();
    }
    return true;
}

Status writeText(const std::filesystem::path& path, const std::string& text) {
    Result<OutputFile> file = OutputFile::open(path.string());
    if (!file) return file.error();
    return file->write(std::as_bytes(std::span(text)));
}

/// The page, its tables and the document itself.
Status writePage(const std::filesystem::path& folder, const Json& document) {
    if (const Status done = writeText(folder / "index.html", chart::pageOf(document)); !done)
        return done;
    if (const Status done = writeText(folder / "results.json", document.dump(1) + '\n'); !done)
        return done;
    for (const std::string& table : chart::tableNames())
        if (const Status done = writeText(folder / (table + ".csv"), chart::csvOf(document, table));
            !done)
            return done;
    return Done{};
}

/// The pictures beside it. `reached` gets how many; false: interrupted before the last.
Result<bool> writePictures(const std::filesystem::path& folder, const Json& document,
                           std::string& reached) {
    const auto take = [&](const chart::Picture& picture, std::size_t number,
                          std::size_t of) -> Result<bool> {
        if (number == 1) std::fprintf(stderr, "pictures: %zu ...\n", of);
        const Status done = writeText(folder / (picture.name + ".svg"), picture.svg);
        if (!done) return done.error();
        reached = std::to_string(number) + " of " + std::to_string(of) + " pictures";
        return !interrupted() || number == of;
    };
    return chart::drawPictures(document, take);
}

/// The folder, which is tried before the work so that one that cannot be written to costs none, and
/// is gone again if it was made in vain.
class OutFolder {
 public:
    static Result<OutFolder> open(const std::filesystem::path& path) {
        std::error_code wrong;
        const bool made = std::filesystem::create_directories(path, wrong);
        if (wrong) return Error{"--out: " + path.string() + ": cannot be made: " + wrong.message()};
        OutFolder folder(made ? path : std::filesystem::path());
        const Result<OutputFile> page = OutputFile::open((path / "index.html").string());
        if (!page) return Error{"--out: " + page.error().message};
        return folder;
    }
    ~OutFolder() {
        std::error_code ignored;  // of one that is not empty
        if (!m_made.empty()) std::filesystem::remove(m_made, ignored);
    }
    OutFolder(OutFolder&& other) noexcept : m_made(std::exchange(other.m_made, {})) {}
    OutFolder& operator=(OutFolder&&) = delete;
    OutFolder(const OutFolder&) = delete;
    OutFolder& operator=(const OutFolder&) = delete;

 private:
    explicit OutFolder(std::filesystem::path made) : m_made(std::move(made)) {}
    std::filesystem::path m_made;  // empty: it was there
};

/// What `huestep stability --json` said.
Result<Json> readStability(const std::string& path) {
    const Result<std::vector<std::byte>> bytes = readFile(path, 64u << 20);
    if (!bytes) return bytes.error();
    const std::string_view text(reinterpret_cast<const char*>(bytes->data()), bytes->size());
    const Json said = Json::parse(text, nullptr, false);
    const std::string wrong =
        path + ": not what `huestep stability --json` prints: it has no list \"rows\" of verdicts";
    if (!said.is_object() || !said.contains("rows") || !said["rows"].is_array())
        return Error{wrong};
    for (const Json& row : said["rows"])
        for (const char* key : {"row", "name", "scene", "method", "pass", "judged"})
            if (!row.is_object() || !row.contains(key)) return Error{wrong};
    return said["rows"];
}

Answer makeCharts(const Options& options) {
    Findings findings;
    if (!options.stability.empty()) {
        const Result<Json> rows = readStability(options.stability);
        if (!rows) return rows.error();
        findings.stability = *rows;
    }
    const std::filesystem::path folder = options.folder;
    const Result<OutFolder> open = OutFolder::open(folder);
    if (!open) return open.error();
    findings.extent = options.extent();
    const std::uint64_t begin = nanoseconds();
    const Result<bool> done = measureAll(findings);
    if (!done) return done.error();
    findings.finished = *done;
    findings.seconds = static_cast<double>(nanoseconds() - begin) * 1e-9;
    if (!findings.finished) return stopped("nothing was written");
    const Json document = chart::documentOf(findings);
    if (const Status written = writePage(folder, document); !written) return written.error();
    std::string pictures;
    const Result<bool> drawn = writePictures(folder, document, pictures);
    if (!drawn) return drawn.error();
    if (options.json)
        print(document);
    else
        std::printf("%s\n%zu points, %zu verdicts, in %.0f s\npage %s\n", originLine().c_str(),
                    findings.points.size(), document.at("stability").size(), findings.seconds,
                    (folder / "index.html").string().c_str());
    if (!*drawn) return stopped("with the page, the tables and " + pictures + " written");
    return Exit::Done;
}

}  // namespace

void addChart(Menu& menu) {
    const auto o = std::make_shared<Options>();
    CLI::App* sub =
        menu.add("chart", "Charts speed against accuracy for every method: a page, SVG and CSV.",
                 "huestep chart --out charts --quick", [o] { return makeCharts(*o); });
    sub->add_option("--out", o->folder, "Folder for the page, made if it is not there")->required();
    sub->add_option("--stability", o->stability,
                    "Take the stability table from this file, that `huestep stability --json` "
                    "printed, instead of running the suite");
    CLI::Option* quick = sub->add_flag(
        "--quick", o->quick, "Fewer and smaller runs: within two minutes on a quiet machine");
    sub->add_flag("--smoke", o->smoke,
                  "Hardly any runs: to see that it works, no times worth using")
        ->excludes(quick);
    sub->add_flag("--json", o->json, "Print the document that the page shows");
}

}  // namespace huestep::tools
