#include "graph/node_type.h"

namespace sherd {
namespace {

template <class T>
const T* findNamed(const std::vector<T>& list, const std::string& name) {
  for (const T& entry : list)
    if (entry.name == name) return &entry;
  return nullptr;
}

}  // namespace

const PortInfo* NodeType::input(const std::string& port) const { return findNamed(inputs, port); }
const PortInfo* NodeType::output(const std::string& port) const { return findNamed(outputs, port); }
const ParamInfo* NodeType::param(const std::string& wanted) const { return findNamed(params, wanted); }

}  // namespace sherd
