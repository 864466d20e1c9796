// `brick plot`: a record (`--record`) as a picture, SVG or PNG: series over time, a panel for each kind of number, or a
// path of two columns coloured by its speed. gnuplot reads the file and draws; this writes what it is told
// (docs/record.md).
#include <fnmatch.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/byte_text.h"
#include "app/commands.h"
#include "app/time_text.h"
#include "systemc/core/input_file.h"
#include "systemc/core/usage_error.h"

namespace brick {

namespace {

namespace fs = std::filesystem;

constexpr int kWidth = 900, kPanelHeight = 190, kMargin = 60, kPathSize = 760;
constexpr std::size_t kMostNames = 9;                 // that a legend shows
constexpr std::size_t kLegend = 28, kLegendLine = 9;  // characters: its least width, the line beside a name

// Names of a line of RFC 4180.
std::vector<std::string> fields(const std::string& line) {
  std::vector<std::string> list(1);
  bool quoted = false;
  for (const char c : line) {
    if (c == '"')
      quoted = !quoted;
    else if (c == ',' && !quoted)
      list.emplace_back();
    else if (c != '\r')
      list.back() += c;
  }
  return list;
}

// Of the picture, in ms.
struct Window {
  std::optional<double> from, to;
  bool has(double ms) const { return !(from && ms < *from) && !(to && ms > *to); }
};

Window window_of(const PlotOptions& o) {
  const auto bound = [](const char* option, const std::string& text) -> std::optional<double> {
    if (text.empty()) return std::nullopt;
    try {
      return static_cast<double>(parse_time(text)) * 1e-12;
    } catch (const UsageError& e) { throw UsageError(fmt::format("{}: {}", option, e.what())); }
  };
  const Window window{bound("--from", o.from), bound("--to", o.to)};
  if (window.from && window.to && *window.from >= *window.to)
    throw UsageError(fmt::format("--from {}: is not before --to {}; expected the earlier time first", o.from, o.to));
  return window;
}

// Decimal and finite: gnuplot leaves other values out, or takes them for others.
std::optional<double> number_of(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool good = error == std::errc() && end == text.data() + text.size() && std::isfinite(value);
  return good ? std::optional(value) : std::nullopt;
}

// The first of the numbers of a row, nothing where it has others than `count` of them.
std::optional<double> time_of(const std::string& row, std::size_t count) {
  double time = 0;
  std::size_t at = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t comma = row.find(',', at), end = std::min(comma, row.size());
    const std::optional<double> value = number_of(std::string_view(row).substr(at, end - at));
    if (!value || (comma == std::string::npos) != (i + 1 == count)) return std::nullopt;
    if (i == 0) time = *value;
    at = end + 1;
  }
  return time;
}

// gnuplot draws what it can of a file and is silent about the rest.
void check_rows(std::ifstream& in, const std::string& file, std::size_t columns, const Window& window) {
  std::optional<double> first;
  double last = 0;
  std::size_t number = 1, drawn = 0;
  for (std::string row; ++number, std::getline(in, row);) {
    if (!row.empty() && row.back() == '\r') row.pop_back();
    const std::optional<double> time = time_of(row, columns);
    if (!time)
      throw UsageError(fmt::format("{}:{}: {}; expected {} numbers, as in its first line", file, number,
                                   beginning_of(row), columns));
    if (!first) first = time;
    last = *time;
    drawn += window.has(*time) ? 1u : 0u;
  }
  if (!first) throw UsageError(fmt::format("{}: has no row; expected a run with servo interrupts", file));
  if (drawn < 2)
    throw UsageError(fmt::format("{}: has {} rows to draw, of {} from {} to {} ms; expected two or more", file, drawn,
                                 number - 2, *first, last));
}

std::vector<std::string> columns_of(const std::string& file, const Window& window) {
  need_regular_file(file, "a record, as --record writes it");
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  std::vector<std::string> names = fields(line);
  if (names[0] != "time_ms" || names.size() < 2)
    throw UsageError(fmt::format("{}: begins with `{}`; expected a record, whose first line begins with time_ms", file,
                                 beginning_of(names[0])));
  check_rows(in, file, names.size(), window);
  return names;
}

// What stands behind the end of a line would be a command of its own.
std::string quoted(const std::string& text) {
  if (text.find('\n') != std::string::npos)
    throw UsageError(fmt::format("{}: has an end of a line; expected a name or text of one line", beginning_of(text)));
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? "''" : std::string(1, c);
  return result + "'";
}

// To gnuplot <NAME and |NAME are programs, and - is its input.
std::string quoted_file(const std::string& name) {
  const bool plain = std::isalnum(static_cast<unsigned char>(name[0])) != 0 || name[0] == '/' || name[0] == '.';
  return quoted(plain ? name : "./" + name);
}

struct Column {
  std::size_t number;  // from 1
  std::string name;
};

std::string of_column(const Column& column) { return fmt::format("(column({}))", column.number); }

// What kind of number a column is: the end of its name, positions together.
std::string kind_of(const std::string& name) {
  const std::size_t dot = name.rfind('.');
  const std::string end = dot == std::string::npos ? name : name.substr(dot + 1);
  return end == "commanded" || end == "actual" ? "position" : end;
}

std::string label_of(const std::string& kind) {
  if (kind == "position" || kind == "error") return kind + ", counts";
  if (kind == "velocity") return kind + ", counts/ms";
  if (kind == "acceleration") return kind + ", counts/ms^2";
  if (kind == "feed") return kind + ", units/ms";
  return kind;
}

std::vector<Column> chosen(const std::vector<std::string>& names, const std::string& file, const std::string& text) {
  std::vector<Column> list;
  std::string item;
  const auto take = [&] {
    if (item.empty()) return;
    const std::size_t before = list.size();
    for (std::size_t i = 1; i < names.size(); ++i)
      if (names[i] == item || fnmatch(item.c_str(), names[i].c_str(), 0) == 0) list.push_back({i + 1, names[i]});
    if (list.size() == before)
      throw UsageError(fmt::format("{}: no column {}; expected {}", file, beginning_of(item),
                                   fmt::join(names.begin() + 1, names.end(), ", ")));
    item.clear();
  };
  for (const char c : text.empty() ? std::string("*") : text)
    if (c == ' ' || c == ';')
      take();
    else
      item += c;
  take();
  return list;
}

struct Limit {
  std::string kind;
  double value;
};

std::vector<Limit> limits_of(const std::vector<std::string>& texts) {
  std::vector<Limit> limits;
  for (const std::string& text : texts) {
    const std::size_t equals = text.find('=');
    const std::optional<double> value = equals == std::string::npos || equals == 0
                                            ? std::nullopt
                                            : number_of(std::string_view(text).substr(equals + 1));
    if (!value)
      throw UsageError(fmt::format("--limit {}: is no limit; expected one like velocity=32", beginning_of(text)));
    limits.push_back({text.substr(0, equals), *value});
  }
  return limits;
}

std::string bound(const std::optional<double>& ms, const char* otherwise) {
  return ms ? fmt::format("{}", *ms) : otherwise;
}

std::string terminal(const PlotOptions& o, int height) {
  const std::string ending = fs::path(o.output).extension();
  if (ending == ".svg")
    return fmt::format("set terminal svg noenhanced size {},{} font 'sans-serif,12' background rgb 'white'", kWidth,
                       height);
  if (ending == ".png")
    return fmt::format("set terminal pngcairo noenhanced size {},{} font 'sans,10'", kWidth, height);
  throw UsageError(fmt::format("--output {}: unknown kind of picture; expected FILE.svg or FILE.png", o.output));
}

struct Source {
  std::string file, prefix;
  std::vector<Column> columns;
  const char* style;
};

std::string series_script(const PlotOptions& o, const Window& window, const std::vector<Source>& sources) {
  std::vector<std::string> kinds;
  for (const Source& s : sources)
    for (const Column& column : s.columns)
      if (const std::string kind = kind_of(column.name); std::find(kinds.begin(), kinds.end(), kind) == kinds.end())
        kinds.push_back(kind);
  const std::vector<Limit> limits = limits_of(o.limits);
  for (const Limit& l : limits)
    if (std::find(kinds.begin(), kinds.end(), l.kind) == kinds.end())
      throw UsageError(fmt::format("--limit {}: nothing of that kind is drawn; expected {}", beginning_of(l.kind),
                                   fmt::join(kinds, ", ")));
  std::size_t legend = kLegend;  // its width in characters
  for (const Source& s : sources)
    for (const Column& column : s.columns)
      legend = std::max(legend, s.prefix.size() + column.name.size() + kLegendLine);
  std::string script = terminal(o, kPanelHeight * static_cast<int>(kinds.size()) + kMargin);
  script += fmt::format(
      "\nset output {}\nset datafile separator ','\nset xrange [{}:{}]\nset grid lc rgb '#dddddd'\nset key outside "
      "right "
      "top\n"
      "set lmargin 12\nset rmargin {}\nset multiplot layout {},1 title {}\n",
      quoted_file(o.output), bound(window.from, "*"), bound(window.to, "*"), legend, kinds.size(), quoted(o.title));
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    std::vector<std::string> curves;
    int colour = 0;
    for (const Source& s : sources) {
      colour = 0;
      for (const Column& column : s.columns)
        if (kind_of(column.name) == kinds[i])
          curves.push_back(fmt::format("{} using 1:{} with lines lw 1.5 lc {} {} title {}", quoted_file(s.file),
                                       of_column(column), ++colour, s.style, quoted(s.prefix + column.name)));
    }
    for (const Limit& l : limits)
      if (l.kind == kinds[i])
        for (const double sign : {1.0, -1.0})
          curves.push_back(fmt::format("{} with lines lc rgb '#c00000' dt 2 notitle", sign * l.value));
    if (curves.size() > kMostNames) script += "set key off\n";
    script += fmt::format("set ylabel {}\nset xlabel {}\nplot {}\nset key on\n", quoted(label_of(kinds[i])),
                          quoted(i + 1 == kinds.size() ? "ms" : ""), fmt::join(curves, ", "));
  }
  return script + "unset multiplot\n";
}

// Colour: the way between two rows by their time. Rows outside --from and --to are left out.
std::string path_script(const PlotOptions& o, const Window& window, const std::vector<Source>& sources) {
  std::string script =
      terminal(o, kPathSize) + fmt::format(
                                   "\nset output {}\nset datafile separator ','\nset grid lc rgb '#dddddd'\n"
                                   "set size ratio -1\nset offsets graph 0.03, graph 0.03, graph 0.03, graph 0.03\nset "
                                   "key off\nset title {}\nset cblabel 'speed, per ms'\n"
                                   "set palette defined (0 '#440154', 1 '#31688e', 2 '#35b779', 3 '#fde725')\n",
                                   quoted_file(o.output), quoted(o.title));
  script += "pt = NaN\n";
  script += "speed(t,x,y) = (v = sqrt((x-px)**2 + (y-py)**2) / (t-pt), pt = t, px = x, py = y, v)\n";
  script += fmt::format("seen(t,x) = (t >= {} && t <= {}) ? x : NaN\n", bound(window.from, "-1e99"),
                        bound(window.to, "1e99"));
  std::vector<std::string> curves;
  for (const Source& s : sources)
    curves.push_back(fmt::format("{0} using (seen($1,{1})):({2}):(speed($1,{1},{2})) with lines lw 2.5 lc palette",
                                 quoted_file(s.file), of_column(s.columns[0]), of_column(s.columns[1])));
  script += fmt::format("px = 0; py = 0\nset xlabel {}\nset ylabel {}\nplot {}\n", quoted(sources[0].columns[0].name),
                        quoted(sources[0].columns[1].name), fmt::join(curves, ", "));
  return script;
}

// Its end is there: gnuplot passes when there is no room for all of it.
bool is_whole(const std::string& picture) {
  constexpr std::streamoff kEnd = 64;
  std::ifstream in(picture, std::ios::binary | std::ios::ate);
  in.seekg(std::max<std::streamoff>(0, in.tellg() - kEnd));
  const std::string end{std::istreambuf_iterator<char>(in), {}};
  return end.find("</svg>") != std::string::npos || end.find("IEND") != std::string::npos;
}

void run_gnuplot(const std::string& script) {
  const int file = memfd_create("script", 0);
  if (file < 0 || write(file, script.data(), script.size()) != static_cast<ssize_t>(script.size()))
    throw UsageError("gnuplot cannot be started; expected room for what it is told");
  FILE* gnuplot = popen(fmt::format("exec gnuplot -d /dev/fd/{} 2>&1", file).c_str(), "r");
  if (gnuplot == nullptr) throw UsageError("gnuplot cannot be started; expected room for one more process");
  std::string said, line;
  for (int c = 0; (c = std::fgetc(gnuplot)) != EOF;) {
    if (c != '\n') line += static_cast<char>(c);
    if (c == '\n' && !line.empty()) said = std::exchange(line, "");
  }
  const int status = pclose(gnuplot);
  close(file);
  if (status == -1 || !WIFEXITED(status) || WEXITSTATUS(status) == 127)
    throw UsageError("gnuplot is not installed; expected Debian's package gnuplot-nox");
  if (WEXITSTATUS(status) != 0)
    throw UsageError(fmt::format("gnuplot: {}; expected a record and a writable picture", cut_text(said, 200)));
}

// Beside the picture, which stays as it was when there is no new one.
void draw(const std::string& script, const std::string& unfinished, const std::string& picture) {
  std::error_code failed;
  try {
    run_gnuplot(script);
    if (!is_whole(unfinished))
      throw UsageError(fmt::format("--output {}: cannot be written; expected room for a picture", picture));
    fs::rename(unfinished, picture, failed);
    if (failed) throw UsageError(fmt::format("--output {}: {}; expected a file", picture, failed.message()));
  } catch (...) {
    fs::remove(unfinished, failed);
    throw;
  }
}

}  // namespace

int plot_command(const PlotOptions& given) {
  PlotOptions o = given;
  if (o.output.empty()) o.output = fs::path(o.file).replace_extension(".svg");
  need_folder("--output", o.output);
  NamedFiles files;
  files.reads("", o.file);
  files.reads("--beside", o.beside);
  files.writes("--output", o.output);
  files.check();
  if (o.title.empty()) o.title = fs::path(o.file).stem();
  const Window window = window_of(o);
  std::vector<Source> sources;
  for (const std::string& file : o.beside.empty() ? std::vector{o.file} : std::vector{o.file, o.beside}) {
    const std::string prefix = o.beside.empty() ? "" : fs::path(file).stem().string() + " ";
    sources.push_back({file, prefix, chosen(columns_of(file, window), file, o.path.empty() ? o.columns : o.path),
                       sources.empty() ? "" : "dt 3"});
  }
  for (const Source& s : sources)
    if (!o.path.empty() && s.columns.size() != 2)
      throw UsageError(fmt::format("--xy {}: are {} columns; expected two", beginning_of(o.path), s.columns.size()));
  terminal(o, 0);  // or it throws
  const fs::path picture = o.output;
  if (!o.script) o.output = fs::path(picture).replace_extension(".new" + picture.extension().string());
  const std::string script = o.path.empty() ? series_script(o, window, sources) : path_script(o, window, sources);
  if (!o.script) draw(script, o.output, picture.string());
  std::cout << (o.script ? script : picture.string()) << '\n';
  return 0;
}

}  // namespace brick
