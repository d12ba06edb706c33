/// `huestep`: one program, one subcommand a file beside this one.
#include <csignal>
#include <cstdio>
#include <exception>
#include <iostream>

#include "tools/command.h"
#include "tools/floats.h"
#include "tools/interrupt.h"
#include "tools/misuse.h"

namespace huestep::tools {

CLI::App* Menu::add(const std::string& name, const std::string& purpose, const std::string& example,
                    Task action) {
    CLI::App* sub = app.add_subcommand(name, purpose);
    sub->footer("Example:\n  " + example);
    sub->callback([this, action = std::move(action)] { chosen = action; });
    return sub;
}

Exit stopped(const std::string& reached) {
    std::fprintf(stderr, "huestep: stopped before the end, %s\n", reached.c_str());
    return Exit::Stopped;
}

namespace {

/// One sentence on standard error, as the command line's page promises.
int badUse(const std::string& sentence) {
    std::fprintf(stderr, "huestep: %s\n", sentence.c_str());
    return static_cast<int>(Exit::BadUse);
}

/// How the program ends once all that it printed has reached where it goes. A full disk is nobody's
/// success.
int delivered(int status) {
    std::cout.flush();
    if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0 && std::cout.good()) return status;
    return badUse("the output cannot be written");
}

int runProgram(int count, char** words) {
    if (const Status floats = checkFloats(); !floats) return badUse(floats.error().message);
    CLI::App app{"Deterministic 2D physics, hosted in lockstep."};
    app.require_subcommand(1);
    app.set_version_flag("--version", "huestep " HUESTEP_VERSION);
    app.footer(
        "Example:\n  huestep run pyramid:base=20 --ticks 300 --threads 2\n"
        "Each subcommand answers --help with an example of its own.\n"
        "Exit status: 0 done or equal, 1 a difference, 2 bad use or bad input, 130 stopped by "
        "Ctrl-C.");
    Menu menu{app, {}};
    addScenes(menu);
    addRun(menu);
    addVerify(menu);
    addServe(menu);
    addJoin(menu);
    addTicket(menu);
    addKey(menu);
    addReplay(menu);
    addDiff(menu);
    addBench(menu);
    addAccuracy(menu);
    addChart(menu);
    addStability(menu);
    try {
        app.parse(count, words);
    } catch (const CLI::Success& help) {
        return app.exit(help);
    } catch (const CLI::ParseError& wrong) {
        return badUse(explainMisuse(app, wrong, {words + 1, words + count}));
    }
    catchInterrupts();
    // Who talks to others outlives them. Whoever only prints ends with its reader, as is usual.
    if (app.got_subcommand("serve") || app.got_subcommand("join")) std::signal(SIGPIPE, SIG_IGN);
    const Answer answer = menu.chosen();
    if (!answer) return badUse(answer.error().message);
    return static_cast<int>(*answer);
}

}  // namespace
}  // namespace huestep::tools

int main(int count, char** words) {
    try {
        return huestep::tools::delivered(huestep::tools::runProgram(count, words));
    } catch (const std::exception& failure) {
        return huestep::tools::badUse(failure.what());
    }
}
