// A component's half behind the ports: its chip, the packed words of its pins, the register access under way.
#pragma once

#include <cstdint>
#include <list>
#include <memory>
#include <optional>
#include <vector>

#include <systemc>

#include "systemc/component/chip.h"
#include "systemc/component/include/brick/pins.h"
#include "systemc/component/scheduler.h"

namespace brick::component {

class Client {
 public:
  Client(Scheduler& scheduler, const std::vector<PinInfo>& table, std::size_t faces);
  ~Client();

  void set_chip(std::unique_ptr<Chip> chip) { chip_ = std::move(chip); }
  void add(Pin& pin) { pins_.push_back(&pin); }
  const std::vector<Pin*>& pins() const { return pins_; }
  void elaborate();  // once all ports are bound: what is watched, who wakes us

  // For the initiator's process; waits.
  struct Answer {
    std::uint32_t value;
    bool made;  // false: the bus could not
  };
  Answer access(unsigned face, const Cycle& cycle);
  std::optional<std::uint32_t> peek(unsigned face, unsigned address);

  // For the scheduler.
  void start();          // levels of all inputs and outputs
  void show(Tick tick);  // outputs of the edge that is due
  void take(Tick tick);  // touched: inputs and accesses, at the end of an instant
  bool run(Tick limit);  // ahead of kernel time, to the first edge that changes a watched output: true, and it is due
  bool eager() const { return eager_; }
  bool touched() const { return touched_; }  // an input has changed or an access has come
  Tick due() const { return due_; }
  Tick quiet_until() const;

 private:
  class Request;
  struct Face {
    std::list<Request*> waiting;  // by the time of the call, then by the name of the process
    Request* under_way = nullptr;
    bool abandoned = false;  // the cycle under way: its process has been killed
    sc_core::sc_event ended;
  };
  void input_changed(const Pin& pin);
  void set_input(const Pin& pin);
  void touch();
  void foresee();
  void catch_up(Tick tick);
  bool step(Tick limit);
  void deliver(bool all);
  void begin_cycles();
  bool end_cycles();  // one has ended
  bool later_access() const;

  const std::shared_ptr<Scheduler> shared_;
  Scheduler& scheduler_;
  const std::vector<PinInfo>& table_;
  std::unique_ptr<Chip> chip_;
  std::vector<Pin*> pins_;
  std::vector<std::vector<Pin*>> outputs_;  // bound ones, by word
  PinWords inputs_, shown_, watched_;
  std::vector<std::unique_ptr<Face>> faces_;
  bool eager_ = false, touched_ = true, inputs_differ_ = true;
  Tick due_ = 0;
};

}  // namespace brick::component
