// `run --json`: one object a line.
//   {"event":"error","message":…}                          what is wrong with graph or command line, also
//                                                          where that can't be parsed but has --json
//   {"event":"node","name":…,"type":…,"state":…,"ms":…,"threads":…,"message":…}
//                                                          with "context" where it stands for a frame or a
//                                                          wedge, and "graph" where there are several
//   {"event":"done","ok":…,"ms":…,"outputs":[files]}       always last
#pragma once

#include <string>
#include <vector>

#include "cli/console.h"
#include "eval/evaluator.h"
#include "graph/graph.h"

namespace sherd {

class JsonEvents : public EvalListener {
 public:
  JsonEvents(const Graph& graph, Console& console) : graph_(graph), console_(console) {}
  void finished(const NodeReport& report) override;

 private:
  const Graph& graph_;
  Console& console_;
};

void jsonErrors(const Diagnostics& diagnostics, std::ostream& out);
void jsonDone(bool ok, double ms, const std::vector<std::string>& outputs, std::ostream& out);

}  // namespace sherd
