/// What every subcommand of the program is made of.
///
/// A subcommand adds itself to the menu with its options; when the user chooses it, its action
/// runs and answers with an exit status or with a sentence about bad use or bad input.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>

#include "core/result.h"

namespace huestep::tools {

enum class Exit : int {
    Done = 0,      ///< done, or equal
    Differs = 1,   ///< a difference, or a failed check
    BadUse = 2,    ///< bad use or bad input, with one sentence on standard error
    Stopped = 130  ///< by Ctrl-C before the end, as a shell says it; what there is was printed
};

/// How an action ended; the sentence of a failure becomes `Exit::BadUse`.
using Answer = Result<Exit>;
using Task = std::function<Answer()>;

/// Says on standard error that Ctrl-C came before the end, and how far the work had come: "after 3
/// of 10 ticks".
Exit stopped(const std::string& reached);

/// The program's command line and the action that the user chose.
struct Menu {
    CLI::App& app;
    Task chosen;

    /// A new subcommand that runs `action` if chosen. The example ends its `--help`.
    CLI::App* add(const std::string& name, const std::string& purpose, const std::string& example,
                  Task action);
};

void addScenes(Menu& menu);
void addAccuracy(Menu& menu);
void addRun(Menu& menu);
void addVerify(Menu& menu);
void addServe(Menu& menu);
void addJoin(Menu& menu);
void addKey(Menu& menu);
void addReplay(Menu& menu);
void addDiff(Menu& menu);
void addTicket(Menu& menu);
void addBench(Menu& menu);
void addChart(Menu& menu);
void addStability(Menu& menu);

}  // namespace huestep::tools
