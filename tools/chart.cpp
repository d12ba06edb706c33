/// `huestep chart`: speed against accuracy, stability, and what colouring is worth, as one page,
/// pictures and tables.
#include <cstdio>
#include <filesystem>
#include <memory>

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

/// Says what is done, how far the whole is, and how long this took.
void say(const char* part, std::size_t done, std::size_t all, std::uint64_t begin) {
    const double seconds = static_cast<double>(nanoseconds() - begin) * 1e-9;
    std::fprintf(stderr, "%s: part %zu of %zu, %.0f s\n", part, done, all, seconds);
}

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
    struct Part {
        const char* name;
        std::function<Result<bool>()> measure;
    };
    const Part parts[] = {
        {"work-precision", [&f] { return measureWork(f); }},
        {"sizes", [&f] { return chart::measureSizes(f.extent, f.sizes); }},
        {"scenes", [&f] { return chart::measureScenes(f.extent, f.scenes); }},
        {"prices of sharing", [&f] { return chart::measurePrices(f.extent, f.prices); }},
        {"effort by need", [&f] { return chart::measureEffort(f.extent, f.effort); }},
        {"stability", [&f] { return stabilityOf(f); }}};
    std::size_t finished = 0;
    for (const Part& part : parts) {
        const std::uint64_t begin = nanoseconds();
        const Result<bool> done = part.measure();
        if (!done || !*done) return done;
        say(part.name, ++finished, std::size(parts), begin);
    }
    return true;
}

Status writeText(const std::filesystem::path& path, const std::string& text) {
    Result<OutputFile> file = OutputFile::open(path.string());
    if (!file) return file.error();
    return file->write(std::as_bytes(std::span(text)));
}

/// The page, its pictures, its tables and the document itself.
Status writeAll(const std::filesystem::path& folder, const Json& document) {
    if (const Status done = writeText(folder / "index.html", chart::pageOf(document)); !done)
        return done;
    if (const Status done = writeText(folder / "results.json", document.dump(1) + '\n'); !done)
        return done;
    for (const std::string& table : chart::tableNames())
        if (const Status done = writeText(folder / (table + ".csv"), chart::csvOf(document, table));
            !done)
            return done;
    const Result<std::vector<chart::Picture>> pictures = chart::picturesOf(document);
    if (!pictures) return pictures.error();
    for (const chart::Picture& picture : *pictures)
        if (const Status done = writeText(folder / (picture.name + ".svg"), picture.svg); !done)
            return done;
    return Done{};
}

/// So that a folder that cannot be written to costs no work.
Status openFolder(const std::filesystem::path& folder) {
    std::error_code wrong;
    std::filesystem::create_directories(folder, wrong);
    if (wrong) return Error{"--out " + folder.string() + ": " + wrong.message()};
    const Result<OutputFile> page = OutputFile::open((folder / "index.html").string());
    return page ? Status(Done{}) : Status(page.error());
}

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
    if (const Status open = openFolder(folder); !open) return open.error();
    findings.extent = options.extent();
    const std::uint64_t begin = nanoseconds();
    const Result<bool> done = measureAll(findings);
    if (!done) return done.error();
    findings.finished = *done;
    findings.seconds = static_cast<double>(nanoseconds() - begin) * 1e-9;
    if (!findings.finished) return stopped("nothing was written");
    const Json document = chart::documentOf(findings);
    if (const Status written = writeAll(folder, document); !written) return written.error();
    if (options.json)
        print(document);
    else
        std::printf("%s\n%zu points, %zu verdicts, in %.0f s\npage %s\n", originLine().c_str(),
                    findings.points.size(), document.at("stability").size(), findings.seconds,
                    (folder / "index.html").string().c_str());
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
    CLI::Option* quick =
        sub->add_flag("--quick", o->quick, "Fewer and smaller runs: within two minutes");
    sub->add_flag("--smoke", o->smoke,
                  "Hardly any runs: to see that it works, no times worth using")
        ->excludes(quick);
    sub->add_flag("--json", o->json, "Print the document that the page shows");
}

}  // namespace huestep::tools
