// The `brick` command: parses the line and calls the command, with the benches from the room of the tests, which no
// other file of this folder knows. Exit status: 0 passed, 1 failed, 2 bad usage or bad input with one line on stderr
// (docs/command.md).
#include <fcntl.h>
#include <unistd.h>

#include <climits>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <iostream>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <systemc>

#include "app/build_info.h"
#include "app/byte_text.h"
#include "app/commands.h"
#include "app/control/command.h"
#include "app/cpu_command.h"
#include "app/line_cover.h"
#include "app/paths.h"
#include "app/regress/command.h"
#include "app/run_bench.h"
#include "systemc/core/usage_error.h"
#include "testbench/benches/benches.h"

namespace brick {
namespace {

constexpr const char* kAbout =
    "brick: a virtual Turbo PMAC2 / Geo Brick LV, as RTL and as SystemC model, with its firmware";
constexpr const char* kDefaultInstructions = "10000000000";
constexpr double kMostMinutes = 60 * 24 * 365;

unsigned job_count(const std::string& text) {
  constexpr std::uint64_t kMostJobs = 1024;
  const std::uint64_t jobs = parse_count("--jobs", text);
  if (jobs == 0 || jobs > kMostJobs) throw UsageError(fmt::format("--jobs {}: expected 1 to {}", text, kMostJobs));
  return static_cast<unsigned>(jobs);
}

// CLI::Range lets what is no number pass.
CLI::Validator within(double least, double most) {
  return CLI::Validator(
      [least, most](const std::string& text) {
        char* end = nullptr;
        const double value = std::strtod(text.c_str(), &end);
        const bool good = end != text.c_str() && *end == '\0' && value >= least && value <= most;
        return good ? std::string() : fmt::format("{} is not a number from {:.10g} to {:.10g}", text, least, most);
      },
      "");
}

void add_end_with(CLI::App& command, int& parent) {
  command.add_option("--end-with", parent, "ends when process PID, which has started it, has ended")
      ->type_name("PID")
      ->check(within(1, INT_MAX));
}

// An empty text is a mistake, of a variable that is not set for example, and no option left out.
void refuse_empty(CLI::App& command) {
  for (CLI::Option* option : command.get_options([](const CLI::Option* o) { return o->get_items_expected_max() > 0; }))
    option->check(
        CLI::Validator([](const std::string& text) { return std::string(text.empty() ? "is empty" : ""); }, ""));
}

struct Commands {
  CLI::App app{kAbout, "brick"};
  std::function<int()> chosen;

  RunOptions run_options, exec_options, console_options;
  ServeOptions serve_options;
  ControlOptions control_options;
  TimingOptions timing_options;
  PlotOptions plot_options;
  RegressOptions regress_options;
  std::string cover, bench, script, history, elf, board, jobs, max_instructions = kDefaultInstructions;
  bool negative = false, raw = false, list_json = false, boards_json = false;

  Commands() {
    app.require_subcommand(1);
    app.footer("Exit status: 0 passed; 1 failed; 2 bad usage or bad input.");
    app.set_version_flag("--version", [] { return version_text(default_firmware_if_any()); });
    auto* list = app.add_subcommand("list", "benches with one line each");
    list->add_flag("--json", list_json, "as JSON");
    list->callback([this] { chosen = [this] { return list_command(all_benches(), list_json); }; });

    auto* run = app.add_subcommand("run", "runs a testbench: steps, verdict, simulated and wall time");
    run->add_option("BENCH", bench, "name of the bench, see brick list")->required();
    add_run_options(*run, run_options, "lockstep");
    add_plant_options(*run, run_options);
    run->add_flag("--negative", negative, "negative control: a deliberate fault, with which the bench must fail");
    run->add_option("--size", run_options.size,
                    "how much of a bench that has no end of its own: lines of rotary-machining")
        ->type_name("N");
    run->add_option("--cover", cover, "the lines of the firmware that were executed, as lcov's tracefile, to FILE")
        ->type_name("FILE");
    run->callback([this, run] {
      if (run->count("--board") == 0) run_options.board.clear();  // the bench's own
      run_options.files.writes("--cover", cover);
      chosen = [this] {
        return run_bench(all_benches(), run_options, bench, negative, line_cover(cover, run_options));
      };
    });

    auto* exec =
        app.add_subcommand("exec", "sends a command file or host script to the started controller, prints the replies");
    exec->add_option("FILE", script, "command file or host script, - = standard input")->required();
    add_run_options(*exec, exec_options, "systemc");
    add_plant_options(*exec, exec_options);
    exec->add_flag("--raw", raw, "print every byte sent by the controller, control bytes as <06>");
    exec->footer(
        "The file holds the controller's command lines, comments, #include #define #ifdef (docs/scripts.md) and @wait "
        "@until @signal @pic @dpram @jumper @input @encoder "
        "@jpan @reset @power "
        "@expect @time.");
    exec->callback([this] {
      exec_options.files.reads("", script);
      chosen = [this] { return exec_command(exec_options, script, raw); };
    });

    auto* console = app.add_subcommand("console", "talks to the started controller: line editing, its control keys");
    add_run_options(*console, console_options, "systemc");
    add_plant_options(*console, console_options);
    console->add_option("--history", history, "keeps the lines typed in FILE")->type_name("FILE");
    console->footer("Lines are those of brick exec, @ lines and #include too. ^] or @quit ends (docs/console.md).");
    console->callback([this] {
      console_options.files.writes("--history", history);
      chosen = [this] { return console_command(console_options, history); };
    });

    auto* serve = app.add_subcommand(
        "serve", "a controller behind the Ethernet port of a Brick, for host software of the real one");
    serve
        ->add_option("--listen", serve_options.listen,
                     "where, TCP and UDP; port 0 takes a free one, host * every address")
        ->type_name("HOST:PORT")
        ->capture_default_str();
    auto* page = serve->add_option("--page", serve_options.page, "a page to look at it in a browser (docs/page.md)")
                     ->type_name("[HOST:]PORT");
    serve->add_flag("--page-read-only", serve_options.page_read_only, "the page has no buttons and no terminal")
        ->needs(page);
    auto* realtime = serve->add_flag("--realtime", "simulated time follows the clock on the wall, if it can (default)");
    serve->add_flag("--free", serve_options.free, "simulated time passes only while a client waits, and then freely")
        ->excludes(realtime);
    serve->add_flag("--save-takes-long", serve_options.save_takes_long,
                    "the interface does not wait for the end of SAVE: it answers NUL");
    add_run_options(*serve, serve_options.run, "systemc");
    add_plant_options(*serve, serve_options.run);
    add_end_with(*serve, serve_options.end_with);
    serve->callback([this] { chosen = [this] { return serve_command(serve_options); }; });

    auto* control = app.add_subcommand(
        "control", "a controller for a program that holds its clock: JSON-RPC 2.0 on a socket (docs/control.md)");
    control
        ->add_option("SOCKET", control_options.place, "path of a Unix socket that is made, or fd:N, one that is open")
        ->required();
    control->add_flag("--realtime", control_options.realtime,
                      "between calls simulated time follows the clock on the wall, if it can (default: it stands)");
    add_run_options(*control, control_options.run, "systemc");
    add_plant_options(*control, control_options.run);
    add_end_with(*control, control_options.end_with);
    control->callback([this] { chosen = [this] { return control_command(control_options); }; });

    auto* timing = app.add_subcommand(
        "timing", "bus-timing report of a testbench: rules, margins, BREQ and interrupt times, bus load");
    timing->add_option("BENCH", timing_options.bench, "name of the bench, see brick list; not needed with --sweep");
    add_run_options(*timing, timing_options.run, "systemc");
    timing->add_flag("--sweep", timing_options.sweep,
                     "instead: the least wait states of each region at each CPU clock, found by driving the bus");
    timing
        ->add_option("--wavedrom", timing_options.wavedrom,
                     "write the read with the least margin as a WaveDrom figure to FILE")
        ->type_name("FILE");
    timing->callback([this, timing] {
      if (timing->count("--board") == 0 && !timing_options.sweep) timing_options.run.board.clear();
      timing_options.run.files.writes("--wavedrom", timing_options.wavedrom);
      chosen = [this] { return timing_command(all_benches(), timing_options); };
    });

    auto* plot = app.add_subcommand("plot", "draws a record (--record) as SVG or PNG: series over time, or a path");
    plot->add_option("FILE", plot_options.file, "record, FILE.csv")->required();
    plot->add_option("--output,-o", plot_options.output, "picture, FILE.svg or FILE.png (default: the record's, .svg)")
        ->type_name("FILE");
    auto* of = plot->add_option("--of", plot_options.columns,
                                "columns, names or globs with blanks between (default: all), a panel for each kind")
                   ->type_name("COLUMNS");
    plot->add_option("--xy", plot_options.path, "two columns: a path instead, its speed as colour")
        ->type_name("COLUMNS")
        ->excludes(of);
    plot->add_option("--beside", plot_options.beside, "a second record in the same panels, dotted")->type_name("FILE");
    plot->add_option("--from", plot_options.from, "first time, for example 10ms");
    plot->add_option("--to", plot_options.to, "last time");
    plot->add_option("--limit", plot_options.limits, "a line at plus and minus, for example velocity=32; repeatable")
        ->type_name("KIND=VALUE")
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    plot->add_option("--title", plot_options.title, "above the picture (default: the record's name)");
    plot->add_flag("--script", plot_options.script, "print what gnuplot is told, draw nothing");
    plot->callback([this] { chosen = [this] { return plot_command(plot_options); }; });

    auto* regress = app.add_subcommand(
        "regress", "the runs of a plan in parallel: benches x engines x boards x seeds; kinds of failure, reports");
    regress->add_option("PLAN", regress_options.plan, "plan in TOML (docs/regress.md)")->required();
    regress
        ->add_option("--output,-o", regress_options.output,
                     "folder of results and reports (default: waves/out/regress/ and the plan's name)")
        ->type_name("DIR");
    regress->add_option("--jobs,-j", jobs, "runs at the same time (default: one a processor)")->type_name("N");
    regress->add_flag("--resume", regress_options.resume,
                      "keep what this build has made already, make what is missing");
    regress->add_flag("--rerun-failed", regress_options.rerun_failed, "the same, but make again what failed");
    regress->add_flag("--list", regress_options.list, "print the command of each run, run nothing");
    regress->add_flag("--no-replay", regress_options.no_replay, "no waveform of the first run of each kind of failure");
    regress
        ->add_option("--fresh-from", regress_options.fresh_from,
                     "where seeds of `fresh` come from (default: the clock)")
        ->type_name("N");
    regress->add_flag("--rank", regress_options.rank, "the runs by what each adds to the covers of those before");
    auto* slurm =
        regress->add_flag("--slurm", regress_options.slurm, "job arrays of a Slurm cluster, --jobs tasks at once");
    regress->add_option("--task-seconds", regress_options.task_seconds, "how long a task of the cluster should take")
        ->capture_default_str()
        ->check(within(1, 86400))
        ->needs(slurm);
    regress->add_flag("--task", regress_options.task, "PLAN is the file of a task of --slurm")->group("");
    regress->add_option("--minutes", regress_options.minutes, "begins no run after so many minutes")
        ->check(within(0, kMostMinutes));
    regress->callback([this] {
      chosen = [this] {
        if (!jobs.empty()) regress_options.jobs = job_count(jobs);
        return regress_command(all_benches(), regress_options);
      };
    });

    auto* boards = app.add_subcommand("boards", "the boards and what is fitted");
    boards->add_option("BOARD", board, "NAME or FILE.toml: all about this one (default: a table of all)");
    boards->add_flag("--json", boards_json, "as JSON");
    boards->callback([this] { chosen = [this] { return boards_command(board, boards_json); }; });

    auto* cpu =
        app.add_subcommand("cpu", "runs a bare program on the CPU model alone, until it writes the symbol tohost");
    cpu->add_option("FILE", elf, "RV32IMC program, FILE.elf")->required();
    cpu->add_option("--max-instructions", max_instructions, "gives up after so many instructions")
        ->capture_default_str();
    cpu->callback(
        [this] { chosen = [this] { return cpu_command(elf, parse_count("--max-instructions", max_instructions)); }; });

    for (CLI::App* command : app.get_subcommands(nullptr)) refuse_empty(*command);
  }
};

// One line: an end of a line within it, as in the name of a file, is shown.
int report_usage(const std::string& where, const std::string& text) {
  std::cerr << where << ": " << readable_text(text) << '\n';
  return 2;
}

int main_command(int argc, char** argv) {
  Commands commands;
  std::string where = "brick", known;
  for (const CLI::App* command : commands.app.get_subcommands(nullptr)) {
    known += " " + command->get_name();
    if (argc > 1 && command->get_name() == argv[1]) where += " " + command->get_name();
  }
  if (where == "brick" && (argc < 2 || argv[1][0] != '-'))
    return report_usage(where,
                        fmt::format("{}; expected one of:{}",
                                    argc < 2 ? "no command" : std::string("no command `") + argv[1] + "`", known));
  try {
    commands.app.parse(argc, argv);
  } catch (const CLI::Success& e) {  // --help, --version
    return commands.app.exit(e);
  } catch (const CLI::ParseError& e) {
    return report_usage(where, fmt::format("{}; expected what `{} --help` shows", e.what(), where));
  }
  try {
    return commands.chosen();
  } catch (const std::filesystem::filesystem_error& e) {  // a name of any option that the system does not take
    return report_usage(where, fmt::format("{}: {}; expected the name of a file that can be reached",
                                           cut_text(e.path1().string()), e.code().message()));
  } catch (const std::exception& e) {  // what is wrong during a run is caught by the commands
    return report_usage(where, e.what());
  }
}

// The next file would get the number of a stream that the caller has closed, and with it the lines of the command.
void replace_closed_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (fcntl(stream, F_GETFD) < 0) open("/dev/null", stream == STDERR_FILENO ? O_WRONLY : O_RDONLY);
}

// A command whose output got lost has not passed.
int with_output_written(int status) {
  const bool written = std::cout.flush().good() && std::fflush(stdout) == 0 && std::ferror(stdout) == 0;
  if (written || status != 0) return status;
  std::cerr << "brick: stdout took no more; expected room for what the command prints\n";
  return 1;
}

}  // namespace
}  // namespace brick

int sc_main(int argc, char** argv) { return brick::with_output_written(brick::main_command(argc, argv)); }

int main(int argc, char** argv) {
  brick::replace_closed_streams();
  std::signal(SIGPIPE, SIG_IGN);                        // a reader that has gone is an error of the write
  std::signal(SIGXFSZ, SIG_IGN);                        // and so is a limit of the size of files
  setenv("SYSTEMC_DISABLE_COPYRIGHT_MESSAGE", "1", 0);  // stdout and stderr belong to the command
  return sc_core::sc_elab_and_sim(argc, argv);
}
