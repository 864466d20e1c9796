// `brick plot`: a record (`--record`) as a picture, SVG or PNG: series over time, a panel for each kind of number, or a
// path of two columns coloured by its speed. gnuplot reads the file and draws; this writes what it is told
// (docs/record.md).
#include <fnmatch.h>
#include <sys/wait.h>

#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/byte_text.h"
#include "app/commands.h"
#include "app/time_text.h"
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

std::vector<std::string> columns_of(const std::string& file) {
  std::ifstream in(file);
  std::string line;
  std::error_code ignored;
  if (!in || fs::is_directory(file, ignored))
    throw UsageError(fmt::format("{}: cannot be read; expected a record, as --record writes it", file));
  std::getline(in, line);
  std::vector<std::string> names = fields(line);
  if (names[0] != "time_ms" || names.size() < 2)
    throw UsageError(fmt::format("{}: begins with `{}`; expected a record, whose first line begins with time_ms", file,
                                 beginning_of(names[0])));
  if (in.peek() == std::ifstream::traits_type::eof())
    throw UsageError(fmt::format("{}: has no row; expected a run with servo interrupts", file));
  return names;
}

std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? "''" : std::string(1, c);
  return result + "'";
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
    std::size_t used = 0;
    double value = 0;
    try {
      if (equals != std::string::npos) value = std::stod(text.substr(equals + 1), &used);
    } catch (const std::exception&) {}
    if (equals == std::string::npos || equals == 0 || used == 0 || equals + 1 + used != text.size())
      throw UsageError(fmt::format("--limit {}: is no limit; expected one like velocity=32", beginning_of(text)));
    limits.push_back({text.substr(0, equals), value});
  }
  return limits;
}

std::string range(const PlotOptions& o) {
  const auto bound = [](const char* option, const std::string& text) {
    if (text.empty()) return std::string("*");
    try {
      return fmt::format("{}", static_cast<double>(parse_time(text)) * 1e-12);
    } catch (const UsageError& e) { throw UsageError(fmt::format("{}: {}", option, e.what())); }
  };
  return fmt::format("[{}:{}]", bound("--from", o.from), bound("--to", o.to));
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

std::string series_script(const PlotOptions& o, const std::vector<Source>& sources) {
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
      "\nset output {}\nset datafile separator ','\nset xrange {}\nset grid lc rgb '#dddddd'\nset key outside right "
      "top\n"
      "set lmargin 12\nset rmargin {}\nset multiplot layout {},1 title {}\n",
      quoted(o.output), range(o), legend, kinds.size(), quoted(o.title));
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    std::vector<std::string> curves;
    int colour = 0;
    for (const Source& s : sources) {
      colour = 0;
      for (const Column& column : s.columns)
        if (kind_of(column.name) == kinds[i])
          curves.push_back(fmt::format("{} using 1:{} with lines lw 1.5 lc {} {} title {}", quoted(s.file),
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
std::string path_script(const PlotOptions& o, const std::vector<Source>& sources) {
  std::string script =
      terminal(o, kPathSize) + fmt::format(
                                   "\nset output {}\nset datafile separator ','\nset grid lc rgb '#dddddd'\n"
                                   "set size ratio -1\nset offsets graph 0.03, graph 0.03, graph 0.03, graph 0.03\nset "
                                   "key off\nset title {}\nset cblabel 'speed, per ms'\n"
                                   "set palette defined (0 '#440154', 1 '#31688e', 2 '#35b779', 3 '#fde725')\n",
                                   quoted(o.output), quoted(o.title));
  const std::string window = range(o);
  const std::size_t colon = window.find(':');
  const std::string from = window.substr(1, colon - 1), to = window.substr(colon + 1, window.size() - colon - 2);
  script += "pt = NaN\n";
  script += "speed(t,x,y) = (v = sqrt((x-px)**2 + (y-py)**2) / (t-pt), pt = t, px = x, py = y, v)\n";
  script += fmt::format("seen(t,x) = (t >= {} && t <= {}) ? x : NaN\n", from == "*" ? "-1e99" : from,
                        to == "*" ? "1e99" : to);
  std::vector<std::string> curves;
  for (const Source& s : sources)
    curves.push_back(fmt::format("{0} using (seen($1,{1})):({2}):(speed($1,{1},{2})) with lines lw 2.5 lc palette",
                                 quoted(s.file), of_column(s.columns[0]), of_column(s.columns[1])));
  script += fmt::format("px = 0; py = 0\nset xlabel {}\nset ylabel {}\nplot {}\n", quoted(sources[0].columns[0].name),
                        quoted(sources[0].columns[1].name), fmt::join(curves, ", "));
  return script;
}

void draw(const std::string& script) {
  std::signal(SIGPIPE, SIG_IGN);  // a gnuplot that is not there is told by its status
  FILE* gnuplot = popen("exec gnuplot -d", "w");
  if (gnuplot == nullptr) throw UsageError("gnuplot cannot be started; expected room for one more process");
  const bool written = std::fwrite(script.data(), 1, script.size(), gnuplot) == script.size();
  const int status = pclose(gnuplot);
  if (status == -1 || !WIFEXITED(status) || WEXITSTATUS(status) == 127)
    throw UsageError("gnuplot is not installed; expected Debian's package gnuplot-nox");
  if (!written || WEXITSTATUS(status) != 0)
    throw UsageError("gnuplot could not draw this, see above; expected a record and a writable picture");
}

}  // namespace

int plot_command(const PlotOptions& given) {
  PlotOptions o = given;
  if (o.output.empty()) o.output = fs::path(o.file).replace_extension(".svg");
  need_folder("--output", o.output);
  if (o.title.empty()) o.title = fs::path(o.file).stem();
  std::vector<Source> sources;
  for (const std::string& file : o.beside.empty() ? std::vector{o.file} : std::vector{o.file, o.beside}) {
    const std::string prefix = o.beside.empty() ? "" : fs::path(file).stem().string() + " ";
    sources.push_back({file, prefix, chosen(columns_of(file), file, o.path.empty() ? o.columns : o.path),
                       sources.empty() ? "" : "dt 3"});
  }
  for (const Source& s : sources)
    if (!o.path.empty() && s.columns.size() != 2)
      throw UsageError(fmt::format("--xy {}: are {} columns; expected two", beginning_of(o.path), s.columns.size()));
  const std::string script = o.path.empty() ? series_script(o, sources) : path_script(o, sources);
  if (!o.script) draw(script);
  fmt::print("{}\n", o.script ? script : o.output);
  return 0;
}

}  // namespace brick
