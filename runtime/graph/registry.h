// The node types that are known to a running program.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "base/result.h"
#include "graph/node_type.h"

namespace sherd {

class Registry {
 public:
  /// Adds a type; an Error where one of the same name and version is there already.
  Result<void> add(NodeType type);
  /// The newest version of the type, or null.
  const NodeType* find(const std::string& name) const;
  /// All types by name.
  std::vector<const NodeType*> all() const;

 private:
  std::map<std::string, NodeType> types_;
};

}  // namespace sherd
