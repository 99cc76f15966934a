#include <algorithm>

#include "graph/subgraph_instance.h"
#include "graph/suggest.h"

namespace sherd {
namespace {

using State = Resolved::State;

/// A walk along links. Each link leads to one other at most, so that no search is needed.
class Walk {
 public:
  Walk(Instance& instance, const LinkEntry& link, std::string where, Diagnostics& diagnostics)
      : at_(&instance), link_(&link), where_(std::move(where)), diagnostics_(diagnostics) {}

  Resolved toEnd() {
    while (result_.state == State::Unknown) step();
    for (Resolved* way : passed_) *way = result_;
    return result_;
  }

 private:
  void end(State state) { result_.state = state; }
  void complain(std::string what, std::string remedy) {
    diagnostics_.add(link_->origin, where_, std::move(what), std::move(remedy));
    end(State::Broken);
  }

  void step() {
    if (link_->node.empty()) return end(State::Broken);
    if (at_->definition != nullptr && link_->node == "in") return intoInput();
    if (const auto child = at_->children.find(link_->node); child != at_->children.end())
      return intoOutput(*child->second);
    if (at_->names.contains(link_->node)) {
      result_ = {State::Found, at_->prefix + link_->node, link_->output, link_->origin};
      return;
    }
    if (link_->node.find('/') != std::string::npos)
      return complain(inQuotes(link_->node) + " is inside of a subgraph",
                      "declare an output of the subgraph and link to that");
    complain("there is no node " + inQuotes(link_->node), nearNode());
  }

  std::string nearNode() const {
    constexpr std::size_t kMostCompared = 10000;
    std::vector<std::string> names(at_->names.begin(), at_->names.end());
    std::sort(names.begin(), names.end());
    if (at_->definition != nullptr) names.emplace_back("in");
    return names.size() > kMostCompared ? listing(names, "nodes") : suggestion(link_->node, names, "nodes");
  }

  /// Marks the way as followed; false where its end is known already or it turns out to be a loop.
  bool enter(Resolved& way) {
    if (way.state == State::Following) {
      complain("these links only lead to each other", "wire one of them to an output of a node");
    } else if (way.state != State::Unknown) {
      result_ = way;
    } else {
      way.state = State::Following;
      passed_.push_back(&way);
      return true;
    }
    return false;
  }

  void intoInput() {
    const std::vector<DeclaredPort>& inputs = at_->definition->inputs;
    if (link_->output.empty())
      return complain(
          "\"in\" names no input of the subgraph",
          inputs.empty() ? "declare one in \"inputs\"" : "write " + inQuotes("in." + inputs[0].name));
    const DeclaredPort* port = findPort(inputs, link_->output);
    if (port == nullptr)
      return complain("the subgraph declares no input " + inQuotes(link_->output),
                      suggestion(link_->output, namesOf(inputs), "inputs"));
    if (at_->node == nullptr) return end(State::Broken);  // nothing uses the subgraph: what it gets is open
    if (!enter(at_->inputs[port->name])) return;
    for (const LinkEntry& link : at_->node->in)
      if (link.port == port->name) {
        where_ = at_->outer->place(*at_->node, link.port);
        link_ = &link;
        at_ = at_->outer;
        return;
      }
    end(port->optional ? State::Absent : State::Broken);  // a missing one is reported at the node
  }

  void intoOutput(Instance& child) {
    if (child.broken) return end(State::Broken);
    const std::vector<DeclaredPort>& outputs = child.definition->outputs;
    if (outputs.empty())
      return complain(inQuotes(link_->node) + " is a " + child.subgraph + ", which has no outputs",
                      "wire another node");
    const DeclaredPort* port = link_->output.empty() ? &outputs[0] : findPort(outputs, link_->output);
    if (port == nullptr)
      return complain(child.subgraph + " has no output " + inQuotes(link_->output),
                      suggestion(link_->output, namesOf(outputs), "outputs"));
    if (!enter(child.outputs[port->name])) return;
    where_ = child.prefix + "outputs." + port->name;
    link_ = &port->from;
    at_ = &child;
  }

  Instance* at_;
  const LinkEntry* link_;
  std::string where_;
  Diagnostics& diagnostics_;
  Resolved result_;
  std::vector<Resolved*> passed_;
};

}  // namespace

Resolved followLink(Instance& instance, const LinkEntry& link, const std::string& where,
                    Diagnostics& diagnostics) {
  return Walk(instance, link, where, diagnostics).toEnd();
}

const DeclaredPort* findPort(const std::vector<DeclaredPort>& ports, const std::string& name) {
  for (const DeclaredPort& port : ports)
    if (port.name == name) return &port;
  return nullptr;
}

std::vector<std::string> namesOf(const std::vector<DeclaredPort>& ports) {
  std::vector<std::string> names;
  for (const DeclaredPort& port : ports) names.push_back(port.name);
  return names;
}

}  // namespace sherd
