// What computes a component: the SystemC model, the Verilated RTL or both in lock-step, compared at every edge. Model
// and RTL agree pin for pin and edge for edge, so the choice changes speed only. The RTL is in a library of its own
// (brick/rtl.h, target brick::rtl); whoever does not link it need not have it.
#pragma once

#include <memory>

namespace brick::component {

class ChipFactory;

class Engine {
 public:
  explicit Engine(std::shared_ptr<const ChipFactory> factory) : factory_(std::move(factory)) {}
  const ChipFactory& factory() const { return *factory_; }

 private:
  std::shared_ptr<const ChipFactory> factory_;
};

Engine model_engine();

}  // namespace brick::component
