// A component's half behind the ports: its chip, the packed words of its pins, the register access under way.
#pragma once

#include <cstdint>
#include <list>
#include <memory>
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
  std::uint32_t access(unsigned face, const Cycle& cycle);
  std::uint32_t peek(unsigned face, unsigned address);

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
  class Turn;
  struct Face {
    enum { kFree, kAsked, kUnderWay } state = kFree;
    bool abandoned = false;  // the cycle under way, whose process has been killed
    Cycle cycle;
    std::list<const Turn*> queue;  // initiators in the order of their calls; the first has the face
    sc_core::sc_event free, ended;
  };
  void input_changed(const Pin& pin);
  void set_input(const Pin& pin);
  void touch();
  void foresee();
  void catch_up(Tick tick);
  bool step(Tick limit);
  void deliver(bool all);
  void begin_cycles();
  void end_cycles();

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
