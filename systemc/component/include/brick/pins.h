// Ports of a component. A pin may stay unbound: an input then has its idle level, an output costs nothing. A pin of one
// bit is a port of bool, a wider one of sc_uint; a port is an sc_port with the interface of sc_in or sc_out, which may
// not stay unbound: bind it alike, trace it with its component, ask bound() before reading it. Idle levels are 0 where
// the comment of a pin says nothing. A pin that goes both ways is three ports: NAME_i, NAME_o and NAME_oe, high
// while the component drives it; NAME_o is high while it does not.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include <systemc>

namespace brick::component {

class Component;

enum class PinDirection {
  kIn,
  kOut,
  kInner  // no port: compared in lock-step
};

// A row of a component's pin table, which serves ports, documentation, traces and messages alike.
struct PinInfo {
  std::string name;  // of the port
  PinDirection direction;
  unsigned word, lsb, width;  // place in the packed words of inputs or outputs
  std::uint32_t idle;         // level of an input that is not bound
  std::string section;        // of the data sheet
  std::string meaning;        // for the documentation
};

class Pin {
 public:
  virtual ~Pin() = default;
  Pin(const Pin&) = delete;
  Pin& operator=(const Pin&) = delete;

  const PinInfo& info() const { return info_; }
  virtual bool bound() const = 0;
  virtual std::uint32_t read() const = 0;
  virtual void write(std::uint32_t value) = 0;           // outputs only
  virtual const sc_core::sc_event& changed() const = 0;  // inputs only

 protected:
  Pin(Component& owner, std::string_view name, unsigned width);

 private:
  friend class Component;
  virtual void prepare_trace() {}  // before the elaboration ends
  virtual void trace(sc_core::sc_trace_file* file, const std::string& name) const = 0;

  const PinInfo& info_;
};

template <unsigned kWidth>
using PinValue = std::conditional_t<kWidth == 1, bool, sc_dt::sc_uint<static_cast<int>(kWidth)>>;

template <unsigned kWidth = 1>
class Out;

template <unsigned kWidth = 1>
class In : public sc_core::sc_port<sc_core::sc_signal_in_if<PinValue<kWidth>>, 1, sc_core::SC_ZERO_OR_MORE_BOUND>,
           public Pin {
  using Port = sc_core::sc_port<sc_core::sc_signal_in_if<PinValue<kWidth>>, 1, sc_core::SC_ZERO_OR_MORE_BOUND>;
  using Outer = sc_core::sc_port_b<sc_core::sc_signal_inout_if<PinValue<kWidth>>>;

 public:
  In(Component& owner, const std::string& name)
      : Port(name.c_str()), Pin(owner, name, kWidth), idle_(static_cast<PinValue<kWidth>>(info().idle)) {}
  // A signal, or a port of the module around: sc_in, and as with sc_in also sc_out and sc_inout.
  using Port::bind;
  using Port::operator();
  void bind(Outer& port) { sc_core::sc_port_base::bind(port); }
  void operator()(Outer& port) { bind(port); }
  // The pin of another component: a signal belongs between the two.
  template <unsigned kOther>
  void bind(Out<kOther>& pin) = delete;
  template <unsigned kOther>
  void operator()(Out<kOther>& pin) = delete;
  bool bound() const override { return this->get_interface() != nullptr; }
  std::uint32_t read() const override { return static_cast<std::uint32_t>(this->operator->()->read()); }
  void write(std::uint32_t) override {}
  const sc_core::sc_event& changed() const override { return this->operator->()->value_changed_event(); }

 private:
  void trace(sc_core::sc_trace_file* file, const std::string& name) const override {
    sc_core::sc_trace(file, bound() ? this->operator->()->read() : idle_, name);
  }
  const PinValue<kWidth> idle_;
};

template <unsigned kWidth>
class Out : public sc_core::sc_port<sc_core::sc_signal_inout_if<PinValue<kWidth>>, 1, sc_core::SC_ZERO_OR_MORE_BOUND>,
            public Pin {
  using Port = sc_core::sc_port<sc_core::sc_signal_inout_if<PinValue<kWidth>>, 1, sc_core::SC_ZERO_OR_MORE_BOUND>;

 public:
  Out(Component& owner, const std::string& name) : Port(name.c_str()), Pin(owner, name, kWidth) {}
  bool bound() const override { return this->get_interface() != nullptr; }
  std::uint32_t read() const override { return static_cast<std::uint32_t>(this->operator->()->read()); }
  void write(std::uint32_t value) override {
    const_cast<Out&>(*this).operator->()->write(static_cast<PinValue<kWidth>>(value));
  }
  const sc_core::sc_event& changed() const override { return this->operator->()->value_changed_event(); }

 private:
  void prepare_trace() override {
    if (this->bind_count() != 0) return;
    traced_ = std::make_unique<sc_core::sc_signal<PinValue<kWidth>>>((info().name + "_traced").c_str());
    this->bind(*traced_);
  }
  void trace(sc_core::sc_trace_file* file, const std::string& name) const override {
    sc_core::sc_trace(file, this->operator->()->read(), name);
  }
  std::unique_ptr<sc_core::sc_signal<PinValue<kWidth>>> traced_;
};

// NAME0, NAME1, ...
template <class P, std::size_t... kNumber>
std::array<P, sizeof...(kNumber)> pin_array(Component& owner, const std::string& name,
                                            std::index_sequence<kNumber...>) {
  return {P{owner, name + std::to_string(kNumber)}...};
}
template <class P, std::size_t kCount>
std::array<P, kCount> pin_array(Component& owner, const std::string& name) {
  return pin_array<P>(owner, name, std::make_index_sequence<kCount>());
}

}  // namespace brick::component
