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
    : scheduler_(scheduler),
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
  if (touched_) return;
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
  begin_cycles();
  inputs_differ_ = touched_ = false;
  foresee();
}

void Client::begin_cycles() {
  for (unsigned i = 0; i < faces_.size(); ++i) {
    Face& face = *faces_[i];
    if (face.abandoned) chip_->abandon(i);
    face.abandoned = false;
    if (face.state != Face::kAsked) continue;
    chip_->begin(i, face.cycle);
    face.state = Face::kUnderWay;
  }
}

void Client::end_cycles() {
  for (unsigned i = 0; i < faces_.size(); ++i)
    if (faces_[i]->state == Face::kUnderWay && !chip_->busy(i)) {
      faces_[i]->state = Face::kFree;
      faces_[i]->ended.notify(sc_core::SC_ZERO_TIME);  // the outputs of this edge show then
    }
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

// An initiator's place in the queue; it leaves by its destructor when its process is killed or reset, too, wherever it
// waits, and what has not been made then is not made.
class Client::Turn {
 public:
  Turn(Client& client, Face& face) : client_(client), face_(face), place_(face.queue.insert(face.queue.end(), this)) {}
  ~Turn() {
    if (first() && face_.state == Face::kUnderWay) {
      face_.abandoned = true;
      client_.touch();
    }
    if (first()) face_.state = Face::kFree;
    face_.queue.erase(place_);
    face_.free.notify();
  }
  Turn(const Turn&) = delete;
  Turn& operator=(const Turn&) = delete;
  void wait() const {
    while (!first()) sc_core::wait(face_.free);
  }

 private:
  bool first() const { return face_.queue.front() == this; }
  Client& client_;
  Face& face_;
  std::list<const Turn*>::iterator place_;
};

std::uint32_t Client::access(unsigned number, const Cycle& cycle) {
  Face& face = *faces_.at(number);
  const Turn turn(*this, face);
  turn.wait();
  face.cycle = cycle;
  face.state = Face::kAsked;
  touch();
  sc_core::wait(face.ended);
  return chip_->value(number);
}

std::uint32_t Client::peek(unsigned face, unsigned address) {
  catch_up(scheduler_.tick());
  return chip_->peek(face, address);
}

}  // namespace brick::component
