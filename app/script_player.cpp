#include "app/script_player.h"

#include <algorithm>
#include <ostream>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/byte_text.h"
#include "app/command_file.h"
#include "app/hand_encoder.h"
#include "app/signal_watch.h"
#include "systemc/core/usage_error.h"

namespace brick {

namespace {
using Kind = ScriptLine::Kind;
constexpr std::size_t kLongestError = 20, kEasilySeen = 40;  // characters

// With the place where two long texts part, which may be behind what is shown of them.
std::string difference(const std::string& actual, const std::string& expected) {
  const std::size_t same = static_cast<std::size_t>(
      std::mismatch(actual.begin(), actual.end(), expected.begin(), expected.end()).first - actual.begin());
  return fmt::format("got {}, expected {}{}", beginning_of(actual, kControllerLine),
                     beginning_of(expected, kControllerLine),
                     same < kEasilySeen ? "" : fmt::format("; they differ from byte {} on", same + 1));
}
}  // namespace

void ScriptPlayer::fail(const ScriptLine& line, const std::string& text) const {
  throw ScriptFailure(fmt::format("{}: {}: {}", line.place, beginning_of(line.text, kControllerLine), text));
}

void ScriptPlayer::check(const std::vector<ScriptLine>& script) const {
  Machine& machine = link_.bus().machine();
  const Signals& signals = link_.bus().machine().signals();
  for (const ScriptLine& line : script) {
    try {
      if (line.kind == Kind::kSignal || line.kind == Kind::kUntil) {
        const auto id = find_signal(signals, line.name);
        if (line.kind == Kind::kUntil) signal_value_text(signals, id, line.value);
      } else if (line.kind == Kind::kInput) {
        if (find_connector_pin(signals, line.name)) continue;
        const ChannelPinPlace pin = find_channel_pin(signals, line.name);
        if ((machine.driven_motor_inputs(pin.ic, pin.channel) >> pin.pin & 1) != 0)
          throw UsageError(fmt::format("{} is driven by the plant; expected a pin that is free", line.name));
      } else if (line.kind == Kind::kJpan && !machine.inputs().jpan_fitted) {
        throw UsageError(
            "this board has no control panel port; expected a board with JPAN, for example --board turbo-pmac-pci");
      } else if ((line.kind == Kind::kPicWrite || line.kind == Kind::kPicClear) && machine.inputs().pic_8259) {
        throw UsageError("the interrupt controller of this board is an 8259; expected @pic alone");
      } else if (line.kind == Kind::kEncoder && !motor_place(machine.fitted(), line.motor)) {
        unsigned motors = 0;
        while (motor_place(machine.fitted(), motors + 1)) ++motors;
        throw UsageError(fmt::format("no encoder of motor {} on this board; expected 1 to {}", line.motor, motors));
      } else if (line.kind == Kind::kEncoder) {
        const MotorPlace place = *motor_place(machine.fitted(), line.motor);
        if ((machine.driven_motor_inputs(place.ic, place.channel) >> kEncA & 1) != 0)
          throw UsageError(
              fmt::format("the plant turns the encoder of motor {}; expected one without an axis", line.motor));
      }
    } catch (const UsageError& e) { throw line.wrong(e.what()); }
  }
}

void ScriptPlayer::play(const std::vector<ScriptLine>& script) {
  for (std::size_t i = 0; i < script.size(); ++i) {
    last_refused_ = false;
    play_line(script[i]);
    const bool expected = i + 1 < script.size() && script[i + 1].kind == Kind::kExpect;
    if (last_refused_ && !expected) refuse(script[i]);
    ++played_;
  }
}

// The error is the last line of the reply, but for what control characters behind it are answered.
void ScriptPlayer::refuse(const ScriptLine& line) {
  const auto error =
      std::find_if(last_.rbegin(), last_.rend(), [](const auto& text) { return text.rfind("ERR", 0) == 0; });
  const std::string text =
      refused_.add(line.place, line.text, error == last_.rend() ? "ERR" : cut_text(*error, kLongestError));
  if (on_refused && !text.empty()) on_refused(text);
}

void ScriptPlayer::print(const std::vector<std::string>& lines) {
  if (lines.empty()) return;
  if (before_output) before_output();
  for (const auto& text : lines) out_ << text << '\n';
  out_ << std::flush;
}

void ScriptPlayer::keep(const ScriptLine& line, const std::vector<std::string>& lines, bool error) {
  exchanges_.push_back({line.place, line.text, lines, error});
  last_.clear();
  for (const auto& text : lines) last_.push_back(readable_text(text));
  last_refused_ = error;
}

void ScriptPlayer::answer(const ScriptLine& line, const std::vector<std::string>& lines, bool error) {
  keep(line, lines, error);
  print(last_);
}

void ScriptPlayer::print_unsolicited() {
  if (!link_.bus().machine().inputs().jpan_init_n) return;  // looking takes longer than a spike of INIT/ may
  link_.poll();
  std::vector<std::string> lines = link_.take_unsolicited();
  for (auto& text : lines) text = readable_text(text);
  print(lines);
}

void ScriptPlayer::command(const ScriptLine& line) {
  print_unsolicited();
  Reply reply;
  if (line.kind == Kind::kCommand) {
    reply = link_.command(line.text);
  } else {
    for (const char c : line.value) {
      const Reply one = link_.control(static_cast<std::uint8_t>(c));
      reply.raw += one.raw;
      reply.lines.insert(reply.lines.end(), one.lines.begin(), one.lines.end());
      reply.error = reply.error || one.error;
      if (reply.bad_checksum.empty()) reply.bad_checksum = one.bad_checksum;
      if (reply.doubt.empty()) reply.doubt = one.doubt;
      reply.complete = one.complete;
    }
  }
  if (!reply.complete && reply.doubt.empty()) {
    Machine& machine = link_.bus().machine();
    if (link_.bus().tripped())
      fail(line, fmt::format("no reply: the watchdog has tripped (WDO), the CPU stands at {}; expected an answer, "
                             "see @reset and @power",
                             machine.cpu_place()));
    const std::string where = machine.cpu().asleep() ? "" : ", the CPU stands at " + machine.cpu_place();
    fail(line, reply.raw.empty() ? "no reply" + where + "; expected an acknowledge or an error from the controller"
                                 : fmt::format("the reply has no end: {}; expected an acknowledge or an error",
                                               beginning_of(reply.raw)));
  }
  if (!reply.bad_checksum.empty() && reply.doubt.empty()) fail(line, reply.bad_checksum + " (I4)");
  if (raw_) {
    keep(line, reply.lines, reply.error);
    if (!reply.raw.empty()) print({visible_bytes(reply.raw)});
  } else {
    answer(line, reply.lines, reply.error);
  }
  if (!reply.doubt.empty()) fail(line, reply.doubt);
}

void ScriptPlayer::restart(const ScriptLine& line) {
  Machine& machine = link_.bus().machine();
  if (line.kind == Kind::kReset)
    machine.reset();
  else
    machine.power_cycle();
  reconnect(line);
}

void ScriptPlayer::reconnect(const ScriptLine& line) {
  if (!link_.connect(HostLink::kBootTime))
    fail(line, "the controller does not answer after the restart; expected an acknowledge");
}

// The time goes on until the last count.
void ScriptPlayer::turn_encoder(const ScriptLine& line) {
  HostBus& bus = link_.bus();
  const MotorPlace place = motor_place(bus.machine().fitted(), line.motor).value();
  HandEncoder hand(place.ic, place.channel, line.counts, line.rate, bus.now());
  bus.machine().attach(hand);
  try {
    bus.advance_to(hand.end() + 1);
  } catch (...) {
    bus.machine().detach(hand);
    throw;
  }
  bus.machine().detach(hand);
  print_unsolicited();
}

void ScriptPlayer::play_line(const ScriptLine& line) {
  HostBus& bus = link_.bus();
  Machine& machine = bus.machine();
  switch (line.kind) {
    case Kind::kCommand:
    case Kind::kControl:
      command(line);
      break;
    case Kind::kWait:
      bus.wait(fs_to_tick(line.time));
      print_unsolicited();
      break;
    case Kind::kUntil: {
      const auto id = find_signal(machine.signals(), line.name);
      if (!wait_signal(bus, id, signal_value_text(machine.signals(), id, line.value), fs_to_tick(line.time)))
        fail(line, fmt::format("still {}={} at the limit; expected {}", line.name, signal_text(machine.signals(), id),
                               line.value));
      break;
    }
    case Kind::kSignal:
      answer(line, {line.name + "=" + signal_text(machine.signals(), find_signal(machine.signals(), line.name))});
      break;
    case Kind::kPicRead: {
      if (machine.inputs().pic_8259) {
        const HostBus::Pic8259 p = bus.read_8259();
        answer(line, {fmt::format("IRR={:02X} ISR={:02X} IMR={:02X}", p.irr, p.isr, p.imr)});
        break;
      }
      const HostBus::Pic p = bus.read_pic();
      answer(line, {fmt::format("IST={:02X} SIG={:02X} MSK={:02X} ELR={:02X}", p.ist, p.sig, p.msk, p.elr)});
      break;
    }
    case Kind::kPicWrite:
      if (line.edge_level >= 0) bus.write_pic_edge_level(static_cast<std::uint8_t>(line.edge_level));
      if (line.mask >= 0) bus.write_pic_mask(static_cast<std::uint8_t>(line.mask));
      break;
    case Kind::kPicClear:
      bus.clear_pic();
      break;
    case Kind::kDpramRead: {
      std::vector<std::string> words;
      for (std::uint32_t i = 0; i < line.count; ++i)
        words.push_back(fmt::format("{:04X}", bus.dpram_read(line.offset + 2 * i)));
      answer(line, {fmt::format("{}", fmt::join(words, " "))});
      break;
    }
    case Kind::kDpramWrite:
      for (std::uint32_t i = 0; i < line.count; ++i) bus.dpram_write(line.offset + 2 * i, line.words[i]);
      break;
    case Kind::kJumper:
      machine.set_jumper_e3(line.on);
      break;
    case Kind::kInput: {
      if (const auto connector = find_connector_pin(machine.signals(), line.name)) {
        machine.inputs().** connector = line.on;
        machine.apply();
        break;
      }
      const ChannelPinPlace pin = find_channel_pin(machine.signals(), line.name);
      const auto bit = static_cast<std::uint16_t>(1u << pin.pin);
      std::uint16_t& pins = machine.motor_inputs()[pin.ic].pins[pin.channel];
      pins = static_cast<std::uint16_t>(line.on ? pins | bit : pins & ~bit);
      machine.apply_motor_inputs();
      break;
    }
    case Kind::kJpan: {
      std::uint16_t& jpan = machine.inputs().jpan;
      jpan = static_cast<std::uint16_t>((jpan & ~line.inputs) | line.levels);
      const bool released = line.init.value_or(false) && !machine.inputs().jpan_init_n;
      if (line.init) machine.inputs().jpan_init_n = *line.init;
      machine.apply();
      if (released) reconnect(line);
      break;
    }
    case Kind::kEncoder:
      turn_encoder(line);
      break;
    case Kind::kReset:
    case Kind::kPower:
      restart(line);
      break;
    case Kind::kExpect: {
      if (exchanges_.empty()) fail(line, "nothing has been answered yet; expected a line before it that is");
      const std::string actual = fmt::format("{}", fmt::join(last_, "|"));
      if (actual != line.value) fail(line, difference(actual, line.value));
      break;
    }
    case Kind::kTime:
      print({fmt::format("time={} ns", fs_to_ns(machine.now_fs()))});
      break;
  }
}

}  // namespace brick
