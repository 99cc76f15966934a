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
  /// Adds a type; an Error where one of the same name and version is there already, or where a value on its
  /// ports has another size than the same type's values elsewhere: its pack is then built against other
  /// headers.
  Result<void> add(NodeType type);
  /// The newest version of the type that has the name, or had it before and no other has it now; or null.
  const NodeType* find(const std::string& name) const;
  /// All types by name.
  std::vector<const NodeType*> all() const;

 private:
  struct KnownValue {
    std::size_t bytes = 0;
    std::string nodeType;  ///< that had it first
  };
  Result<void> checkValues(const NodeType& type) const;

  std::map<std::string, NodeType> types_;
  std::map<std::string, std::string> formerNames_;  ///< and what the type is called now
  std::map<std::string, KnownValue> values_;        ///< by ValueType::name
};

}  // namespace sherd
