// The subgraphs that a file defines or names, and which of them a node may use where it stands.
#pragma once

#include <deque>
#include <map>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

#include "graph/graph_file.h"

namespace sherd {

struct SubgraphScope;

/// A subgraph that a node may use.
struct KnownSubgraph {
  std::string name;
  Origin origin;
  const Subgraph* definition = nullptr;  ///< null: it couldn't be read, which was reported
  const SubgraphScope* scope = nullptr;  ///< what its own nodes may use
};

/// Names that a node may use: those of the table beside it, then those of the tables around that one. A
/// subgraph in a file of its own sees the tables of that file only.
struct SubgraphScope {
  const SubgraphScope* outer = nullptr;
  std::unordered_map<std::string, const KnownSubgraph*> names;

  /// The subgraph of that name, or null. O(depth).
  const KnownSubgraph* find(const std::string& name) const;
};

class SubgraphLibrary {
 public:
  /// Takes in the tables of a file and of all subgraphs in it, and reads the files that they name, each once.
  /// A file that is missing or holds no subgraph is reported where it is named.
  SubgraphLibrary(const std::vector<SubgraphEntry>& table, Diagnostics& diagnostics);

  /// What the nodes beside the table may use.
  const SubgraphScope& scope() const { return *top_; }
  /// All subgraphs, each before those that are defined in it.
  const std::deque<KnownSubgraph>& all() const { return known_; }

 private:
  struct File {
    std::shared_ptr<const Subgraph> subgraph;  ///< null: it couldn't be read
    const SubgraphScope* scope = nullptr;
  };
  static constexpr int kDeepest = 64;

  const SubgraphScope* addTable(const std::vector<SubgraphEntry>& table, const SubgraphScope* outer,
                                int depth);
  File load(const SubgraphEntry& entry, int depth);
  std::shared_ptr<const Subgraph> read(const SubgraphEntry& entry, const std::filesystem::path& path);

  Diagnostics& diagnostics_;
  std::deque<KnownSubgraph> known_;
  std::deque<SubgraphScope> scopes_;
  std::map<std::filesystem::path, File> files_;
  const SubgraphScope* top_;
};

}  // namespace sherd
