#include "app/profile.h"

#include <algorithm>
#include <cstring>
#include <fstream>

#include <fmt/format.h>

#include "systemc/core/usage_error.h"
#include "systemc/machine/machine.h"

namespace brick {

namespace {

constexpr std::uint32_t kInterrupt = 1u << 31;
constexpr unsigned kReturnAddress = 1, kOtherReturnAddress = 5, kFirstArgument = 10;  // registers

// Every program is executed by executor_step(struct executor*) of firmware/run/executor.h, which begins with struct
// program_position and that with struct program_reader. Bytes from its begin:
constexpr const char* kExecutorStep = "executor_step";
constexpr std::uint32_t kReaderKind = 2, kReaderNumber = 4, kLine = 24, kExecutorBytes = 28;  // `rotary` is the first
constexpr const char* kBackgroundPass = "background_pass";
// To the stack of the work in slices, or back from it (firmware/hal/hal.c); that begins anew with side_main.
constexpr const char* kExchangeStacks = "exchange_stacks";

ElfFile image_of(const std::string& path) {
  try {
    return ElfFile(path);
  } catch (const std::exception& e) { throw UsageError(fmt::format("--profile: {}", e.what())); }
}

std::size_t index(ProfiledTask task) { return static_cast<std::size_t>(task); }

}  // namespace

Profile::Profile(Machine& machine, std::string file, const std::string& image)
    : machine_(machine),
      cpu_(machine.cpu()),
      file_(std::move(file)),
      elf_(image_of(image)),
      out_(image),
      executor_step_(elf_.symbol(kExecutorStep).value_or(0)),
      background_pass_(elf_.symbol(kBackgroundPass).value_or(0)),
      exchange_stacks_(elf_.symbol(kExchangeStacks).value_or(0)),
      on_trap_(cpu_.on_trap),
      on_mret_(cpu_.on_mret),
      on_reset_(cpu_.on_reset),
      levels_{Level(ProfiledTask::kBackground)} {
  cpu_.on_trap = [this](std::uint32_t cause, std::uint32_t pc, Cycle now) {
    if (on_trap_) on_trap_(cause, pc, now);
    trapped(cause);
  };
  cpu_.on_mret = [this](std::uint32_t pc, Cycle now) {
    if (on_mret_) on_mret_(pc, now);
    leaving_ = true;
  };
  cpu_.on_reset = [this] {
    if (on_reset_) on_reset_();
    begin_anew();
  };
  cpu_.on_instruction = [this](std::uint32_t pc, Cycle cycles) { executed(pc, cycles); };
}

Profile::~Profile() {
  cpu_.on_instruction = nullptr;
  cpu_.on_trap = on_trap_;
  cpu_.on_mret = on_mret_;
  cpu_.on_reset = on_reset_;
}

void Profile::trapped(std::uint32_t cause) {
  ProfiledTask task = levels_.back().task;  // of an exception
  if (cause == (kInterrupt | kIrqPhase)) task = ProfiledTask::kPhase;
  if (cause == (kInterrupt | kIrqServo)) task = ProfiledTask::kServo;
  if (cause == (kInterrupt | kIrqHostPort)) task = ProfiledTask::kHostPort;
  if (cause == (kInterrupt | kIrqRealTime)) task = ProfiledTask::kRealTime;
  levels_.emplace_back(task);
  entering_ = true;
}

TaskCycles& Profile::cost(std::uint32_t pc) {
  auto& page = pages_[pc >> 12];
  if (!page) page = std::make_unique<Page>();
  return (*page)[(pc & 0xFFF) >> 1];
}

void Profile::executed(std::uint32_t pc, Cycle cycles) {
  const std::uint32_t to = cpu_.pc();
  Level& level = levels_.back();
  if (entering_) pc = to;  // the trap's cycles are its handler's
  level.stack.own += static_cast<std::uint64_t>(cycles);
  if (level.on_side) side_.own += static_cast<std::uint64_t>(cycles);
  cost(pc)[index(level.task)] += static_cast<std::uint64_t>(cycles);
  if (leaving_) {
    unwind(level);
    judge(level, level.stack.own);
    if (levels_.size() > 1) levels_.pop_back();
  } else if (!entering_ && to != pc + 2 && to != pc + 4) {
    follow(pc, to);
  }
  entering_ = leaving_ = false;
}

// A jump to the first instruction of a function is a call if the return address stands in its register; else the
// function takes the place of the one that jumps.
void Profile::follow(std::uint32_t from, std::uint32_t to) {
  Level& level = levels_.back();
  const bool returns = to == cpu_.reg(kReturnAddress) || to == cpu_.reg(kOtherReturnAddress);
  const auto stack_of = [&]() -> Stack& { return level.on_side ? side_ : level.stack; };
  if (returns && !stack_of().frames.empty() && stack_of().frames.back().callee == exchange_stacks_) {
    if (level.on_side) charge(level, side_);
    level.on_side = !level.on_side;
    if (elf_.begins_function(to)) side_ = Stack{};
  }
  Stack& stack = stack_of();
  if (elf_.begins_function(to)) {
    const auto behind = [&](unsigned link) { return cpu_.reg(link) == from + 2 || cpu_.reg(link) == from + 4; };
    const bool calls = behind(kReturnAddress) || behind(kOtherReturnAddress);
    if (!calls && !stack.frames.empty() && stack.frames.back().callee == to) return;  // a loop from its begin
    const std::uint32_t back = cpu_.reg(behind(kReturnAddress) || !calls ? kReturnAddress : kOtherReturnAddress);
    if (to == executor_step_) {
      charge(level, stack);
      stack.executor = cpu_.reg(kFirstArgument);
      stack.turn = stack.frames.size();
      stack.line_begin = stack.own;
    }
    stack.frames.push_back({from, to, back, !calls, stack.own});
    return;
  }
  const auto waits_there = [to](const Frame& frame) { return frame.back == to; };
  if (!returns || std::none_of(stack.frames.begin(), stack.frames.end(), waits_there)) return;  // within its function
  for (bool found = false; !stack.frames.empty();) {
    const Frame frame = stack.frames.back();
    if (found && frame.back != to) break;
    leave(level, stack);
    found = found || frame.back == to;
    if (frame.back == to && !frame.tail) break;
  }
}

void Profile::leave(Level& level, Stack& stack) {
  const Frame frame = stack.frames.back();
  stack.frames.pop_back();
  const std::uint64_t cycles = stack.own - frame.begin;
  Call& call = calls_[{frame.site, frame.callee}];
  ++call.count;
  call.inclusive[index(level.task)] += cycles;
  if (stack.frames.size() < stack.turn) {
    charge(level, stack);
    stack.executor = 0;
  }
  if (frame.callee == background_pass_ && !unwinds_ && level.task == ProfiledTask::kBackground) judge(level, cycles);
}

// Frames that nothing returns to any more.
void Profile::unwind(Level& level) {
  unwinds_ = true;
  while (!level.stack.frames.empty()) leave(level, level.stack);
  unwinds_ = false;
}

// After a reset; and at the end. What had interrupted has run until now, however long.
void Profile::begin_anew() {
  for (; levels_.size() > 1; levels_.pop_back()) {
    Level& level = levels_.back();
    if (level.on_side) charge(level, side_);
    unwind(level);
    judge(level, level.stack.own);
  }
  unwind(levels_.front());
  levels_.assign(1, Level(ProfiledTask::kBackground));
  side_ = Stack{};
  entering_ = leaving_ = false;
}

void Profile::charge(Level& level, Stack& stack) {
  if (stack.executor == 0) return;
  if (const auto line = line_of(stack.executor)) level.lines[*line] += stack.own - stack.line_begin;
  stack.line_begin = stack.own;
}

// A run of a task has ended.
void Profile::judge(Level& level, std::uint64_t cycles) {
  Worst& worst = worst_[index(level.task)];
  ++worst.runs;
  if (cycles > worst.cycles) {
    worst.cycles = cycles;
    worst.at = machine_.now_fs();
    const auto dearest = std::max_element(level.lines.begin(), level.lines.end(),
                                          [](const auto& a, const auto& b) { return a.second < b.second; });
    worst.line = dearest == level.lines.end() ? std::nullopt : std::optional<Line>(dearest->first);
    worst.of_line = dearest == level.lines.end() ? 0 : dearest->second;
  }
  level.lines.clear();
}

std::optional<Profile::Line> Profile::line_of(std::uint32_t executor) const {
  const std::uint8_t* const memory = cpu_.memory(executor, kExecutorBytes);
  if (memory == nullptr) return std::nullopt;
  const auto word = [&](std::uint32_t at) {
    std::uint32_t v;
    std::memcpy(&v, memory + at, sizeof v);
    return v;
  };
  static constexpr std::array<const char*, 4> kKinds = {"PROG", "PLC", "FORWARD of &", "INVERSE of &"};
  const std::uint32_t kind = word(0) >> (8 * kReaderKind), number = word(kReaderNumber);
  if ((word(0) & 0xFF) != 0) return Line{fmt::format("ROTARY of &{}", number + 1), word(kLine)};
  if (kind >= kKinds.size()) return std::nullopt;
  return Line{fmt::format("{}{}{}", kKinds[kind], kind < 2 ? " " : "", kind < 2 ? number : number + 1), word(kLine)};
}

void Profile::close() {
  begin_anew();
  TaskCycles total{};
  for (const auto& [page, costs] : pages_)
    for (const TaskCycles& of : *costs)
      for (std::size_t task = 0; task < kProfiledTasks; ++task) total[task] += of[task];
  std::uint64_t all = 0;
  for (const std::uint64_t cycles : total) all += cycles;
  for (std::size_t task = 0; task < kProfiledTasks; ++task) {
    const Worst& w = worst_[task];
    text_ +=
        fmt::format("{}{:<10} {:5.1f} %, {} {}", task == 0 ? "" : "\n", kProfiledTaskNames[task],
                    100.0 * static_cast<double>(total[task]) / static_cast<double>(std::max<std::uint64_t>(all, 1)),
                    w.runs, task == 0 ? "passes" : "runs");
    if (w.runs == 0) continue;
    text_ += fmt::format(", the dearest {} cycles, ended at {:.3f} ms", w.cycles, static_cast<double>(w.at) * 1e-12);
    if (w.line) text_ += fmt::format(", {} of them in {}, word {}", w.of_line, w.line->program, w.line->offset);
  }
  write();
}

std::string Profile::text() const { return text_; }

void Profile::write() {
  for (const auto& [page, costs] : pages_)
    for (std::uint32_t i = 0; i < costs->size(); ++i)
      if ((*costs)[i] != TaskCycles{}) out_.cost(page << 12 | i << 1, (*costs)[i]);
  for (const auto& [way, call] : calls_) out_.call(way.first, way.second, call.count, call.inclusive);
  std::ofstream file(file_);
  out_.write(file, text_, [this](std::uint32_t pc) { return elf_.symbol_at(pc); });
  file.close();
  if (!file) throw UsageError(fmt::format("--profile {}: cannot be written; expected a file", file_));
}

}  // namespace brick
