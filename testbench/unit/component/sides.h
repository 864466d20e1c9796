// The block inside of a component with two sockets, whose accesses take several edges and may meet; driven edge by edge
// through its C++ face with the same lists as the component.
#pragma once

#include <optional>

#include "testbench/unit/component/traffic.h"

namespace brick::component {

class Sides {
 public:
  virtual ~Sides() = default;
  virtual void set(const std::string& pin, std::uint32_t value) = 0;
  virtual void edge(Tick t) = 0;
  virtual bool moved() = 0;  // some output may have changed since the last call
  virtual std::map<std::string, std::uint32_t> outputs() const = 0;
  // An access at a side, 0 or 1, which has an edge of its own at t; before and after that edge.
  virtual bool clocked(unsigned side, Tick t) const = 0;
  virtual void begin(unsigned side, const Access& access) = 0;
  virtual void before(unsigned side) = 0;
  virtual std::optional<std::uint32_t> after(unsigned side) = 0;  // it has ended: what it read, or wrote
};

Seen run(Sides& block, const Traffic& traffic);

}  // namespace brick::component
