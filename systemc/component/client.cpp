#include "systemc/component/client.h"

#include <sysc/kernel/sc_dynamic_processes.h>

#include <algorithm>
#include <string>

#include "systemc/component/error.h"
#include "systemc/core/model_block.h"

namespace brick::component {
namespace {
std::size_t words(const std::vector<PinInfo>& table, bool inputs) {
  unsigned count = 0;
  for (const PinInfo& info : table)
    if ((info.direction == PinDirection::kIn) == inputs) count = std::max(count, info.word + 1);
  return count;
}
std::uint32_t mask(const PinInfo& info) { return (info.width >= 32 ? ~0u : (1u << info.width) - 1) << info.lsb; }
void put(PinWords& words, const PinInfo& info, std::uint32_t value) {
  words[info.word] = (words[info.word] & ~mask(info)) | (value << info.lsb & mask(info));
}
}  // namespace

Client::Client(Scheduler& scheduler, const std::vector<PinInfo>& table, std::size_t faces)
    : shared_(scheduler.shared_from_this()),
      scheduler_(scheduler),
      table_(table),
      outputs_(words(table, false)),
      inputs_(words(table, true)),
      shown_(outputs_.size()),
      watched_(outputs_.size()) {
  for (const PinInfo& info : table_)
    if (info.direction == PinDirection::kIn) put(inputs_, info, info.idle);
  while (faces_.size() < faces) faces_.push_back(std::make_unique<Face>());
  scheduler_.add(*this);
}
Client::~Client() { scheduler_.remove(*this); }

void Client::elaborate() {
  scheduler_.check();
  bool any = false;
  for (Pin* pin : pins_) {
    if (!pin->bound()) continue;
    const PinInfo& info = pin->info();
    if (info.direction == PinDirection::kOut) {
      outputs_[info.word].push_back(pin);
      watched_[info.word] |= mask(info);
      any = true;
      continue;
    }
    sc_core::sc_spawn_options process;
    process.spawn_method();
    process.dont_initialize();
    process.set_sensitivity(&pin->changed());
    sc_core::sc_spawn([this, pin] { input_changed(*pin); }, ("on_" + info.name).c_str(), &process);
  }
  chip_->watch(watched_);
  eager_ = any && !chip_->foresees();
}

void Client::start() {
  for (const Pin* pin : pins_)
    if (pin->bound() && pin->info().direction == PinDirection::kIn) set_input(*pin);
  deliver(true);
}

void Client::set_input(const Pin& pin) {
  put(inputs_, pin.info(), pin.read());
  inputs_differ_ = true;
}

// The scheduler executes the edges that have passed with the old levels before it applies the new ones.
void Client::input_changed(const Pin& pin) {
  set_input(pin);
  touch();
}

void Client::touch() {
  if (touched_ && !scheduler_.has_left()) return;
  touched_ = true;
  scheduler_.touched();
}

void Client::show(Tick tick) {
  catch_up(tick);
  deliver(false);
  end_cycles();
  foresee();
}

void Client::take(Tick tick) {
  catch_up(tick);
  if (inputs_differ_) chip_->set_inputs(inputs_);
  inputs_differ_ = false;
  do begin_cycles();
  while (end_cycles());  // some need no edge
  touched_ = later_access();
  foresee();
}

// An access of an initiator, which stands on its process' stack: it goes with it when the process is killed or reset,
// wherever that waits, and what has not been made then is not made. Accesses of one instant have the order of their
// processes' names, which no quantum changes, as it would that of the calls.
class Client::Request {
 public:
  Request(Client& client, Face& face, const Cycle& cycle)
      : client_(client),
        face_(face),
        cycle_(cycle),
        time_(sc_core::sc_time_stamp()),
        process_(sc_core::sc_get_current_process_handle().name()) {
    const auto before = [this](const Request* other) {
      return time_ != other->time_ ? time_ < other->time_ : process_ < other->process_;
    };
    face_.waiting.insert(std::find_if(face_.waiting.begin(), face_.waiting.end(), before), this);
    client_.touch();
  }
  ~Request() {
    face_.waiting.remove(this);
    if (face_.under_way != this) return;
    face_.under_way = nullptr;
    face_.abandoned = true;
    client_.touch();
  }
  Request(const Request&) = delete;
  Request& operator=(const Request&) = delete;

  const Cycle& cycle() const { return cycle_; }
  const sc_core::sc_time& time() const { return time_; }
  void end(const Answer& answer, const sc_core::sc_time& until) {
    answer_ = answer;
    until_ = until;
    ended_ = true;
  }
  bool ended() const { return ended_; }
  const Answer& answer() const { return answer_; }
  const sc_core::sc_time& until() const { return until_; }

 private:
  Client& client_;
  Face& face_;
  const Cycle cycle_;
  const sc_core::sc_time time_;
  const std::string process_;
  bool ended_ = false;
  Answer answer_{0, true};
  sc_core::sc_time until_;  // a bus ends between two edges
};

// One came after the instant that is settled: it is of the next.
bool Client::later_access() const {
  return std::any_of(faces_.begin(), faces_.end(), [this](const auto& face) {
    return !face->waiting.empty() && face->waiting.front()->time() > scheduler_.settled();
  });
}

void Client::begin_cycles() {
  for (unsigned i = 0; i < faces_.size(); ++i) {
    Face& face = *faces_[i];
    if (face.abandoned) chip_->abandon(i);
    face.abandoned = false;
    if (face.under_way != nullptr || face.waiting.empty()) continue;
    if (face.waiting.front()->time() > scheduler_.settled()) continue;
    face.under_way = face.waiting.front();
    face.waiting.pop_front();
    Cycle cycle = face.under_way->cycle();
    cycle.asked = scheduler_.time();
    chip_->begin(i, cycle);
  }
}

bool Client::end_cycles() {
  bool ended = false;
  for (unsigned i = 0; i < faces_.size(); ++i) {
    Face& face = *faces_[i];
    if (face.under_way == nullptr || chip_->busy(i)) continue;
    const auto end = chip_->bus_end(i);
    face.under_way->end({chip_->value(i), !end || end->made},
                        end ? scheduler_.instant_at(end->time) : sc_core::SC_ZERO_TIME);
    face.under_way = nullptr;
    face.ended.notify(sc_core::SC_ZERO_TIME);  // the outputs of this edge show then
    if (!face.waiting.empty()) touched_ = true;
    ended = true;
  }
  return ended;
}

void Client::foresee() { due_ = eager_ ? kNever : std::min(quiet_until(), kNever - 1) + 1; }

Tick Client::quiet_until() const { return chip_->foresees() || eager_ ? chip_->quiet_until() : chip_->no_end_until(); }

bool Client::run(Tick limit) {
  while (chip_->now() < limit)
    if (chip_->run_until(limit)) {
      due_ = chip_->now();
      return true;
    }
  return false;
}

void Client::catch_up(Tick tick) {
  if (chip_->now() > tick)
    raise_error("/brick/ahead",
                "a pin has changed, or a register was accessed, where the engine has run ahead: from sc_main() only "
                "at multiples of TimeOptions::grid");
  while (chip_->now() < tick)
    if (chip_->run_until(tick) && chip_->now() < tick)
      SC_REPORT_FATAL("/brick/late", ("an output changed unforeseen at tick " + std::to_string(chip_->now())).c_str());
}

void Client::deliver(bool all) {
  const PinWords& now = chip_->outputs();
  for (std::size_t word = 0; word < shown_.size(); ++word) {
    const std::uint32_t moved = all ? ~0u : now[word] ^ shown_[word];
    if ((moved & watched_[word]) != 0)
      for (Pin* pin : outputs_[word])
        if ((moved & mask(pin->info())) != 0) pin->write((now[word] & mask(pin->info())) >> pin->info().lsb);
    shown_[word] = now[word];
  }
}

Client::Answer Client::access(unsigned number, const Cycle& cycle) {
  scheduler_.check();
  Face& face = *faces_.at(number);
  Request request(*this, face, cycle);
  while (!request.ended()) sc_core::wait(face.ended);
  if (request.until() > sc_core::sc_time_stamp()) sc_core::wait(request.until() - sc_core::sc_time_stamp());
  return request.answer();
}

std::optional<std::uint32_t> Client::peek(unsigned face, unsigned address) {
  if (!chip_->peeks(face, address)) return {};
  catch_up(scheduler_.tick());
  return chip_->peek(face, address);
}

}  // namespace brick::component
