#include "graph/variables.h"

#include <algorithm>
#include <cstdlib>
#include <system_error>

#include "graph/suggest.h"

namespace sherd {

Environment Environment::ofProcess(std::filesystem::path assets) {
  std::error_code problem;
  return {std::filesystem::current_path(problem), std::move(assets),
          [](const std::string& name) -> std::optional<std::string> {
            const char* value = std::getenv(name.c_str());
            return value == nullptr ? std::nullopt : std::optional<std::string>(value);
          }};
}

Result<Assignment> parseAssignment(const std::string& option, const std::string& typed,
                                   const Environment& environment) {
  const std::size_t equals = typed.find('=');
  if (equals == std::string::npos || equals == 0)
    return Error{option + ' ' + typed + " sets nothing",
                 option == "--set" ? "write --set node.param=value" : "write " + option + " name=value",
                 {},
                 Error::Kind::Input};
  const Source source{option + ' ' + typed, environment.currentDirectory, true};
  return Assignment{typed.substr(0, equals), typed.substr(equals + 1),
                    std::make_shared<const Source>(source)};
}

Variables::Variables(const GraphFile& graph, const std::vector<Assignment>& overrides,
                     const Environment& environment, Diagnostics& diagnostics)
    : environment_(environment), diagnostics_(diagnostics) {
  std::vector<std::string> names;
  for (const Setting& setting : graph.vars) {
    names.push_back(setting.name);
    variables_[setting.name].setting = setting;
  }
  for (const Assignment& assignment : overrides) {
    const auto found = variables_.find(assignment.name);
    const Origin origin{assignment.source, 0, 0};
    if (found == variables_.end())
      diagnostics.add(origin, "", "the graph has no variable " + inQuotes(assignment.name),
                      suggestion(assignment.name, names, "variables"));
    else
      found->second.setting = {assignment.name, origin, parseTyped(assignment.text, assignment.source)};
  }
}

void Variables::sweepOver(const Sweep& sweep, double fps) {
  sweep_ = sweep;
  fps_ = fps;
  at_.clear();
  moveTo(std::vector<int>(sweep.wedge.size() + 1, 0));
  for (auto& [name, variable] : variables_) resolve(variable);
}

void Variables::moveTo(const std::vector<int>& at) {
  if (at == at_) return;
  at_ = at;
  ofFrame_.clear();
  for (std::size_t k = 0; k < sweep_.wedge.size(); ++k) {
    Variable& variable = variables_.at(sweep_.wedge[k].name);
    variable.setting.value = sweep_.wedge[k].values[static_cast<std::size_t>(at[k + 1])];
    variable.wedge = k + 1;
    if (variable.state == State::Resolved) variable.state = State::Untouched;
  }
  for (auto& [name, variable] : variables_)
    if (variable.state == State::Resolved && variable.expanded.reads != 0) variable.state = State::Untouched;
}

std::optional<std::string> Variables::frameText(int digits) const {
  if (sweep_.frames.empty()) return std::nullopt;
  const std::int64_t frame = sweep_.frames[static_cast<std::size_t>(at_[0])];
  std::string text = std::to_string(frame < 0 ? -frame : frame);
  if (text.size() < static_cast<std::size_t>(digits))
    text.insert(0, static_cast<std::size_t>(digits) - text.size(), '0');
  return frame < 0 ? '-' + text : text;
}

/// ${frame}, ${frame:04} and ${time}: seconds since the first frame.
const Expanded* Variables::fromFrame(const std::string& name, const std::string& reference,
                                     const Origin& origin, const std::string& where) {
  if (sweep_.frames.empty()) {
    diagnostics_.add(origin, where, reference + " stands in a graph without frames",
                     "add \"frames\": \"1001-1040\" to the graph, or say --frames 1001");
    return nullptr;
  }
  if (const auto known = ofFrame_.find(name); known != ofFrame_.end()) return &known->second;
  Expanded made{{}, nullptr, 1};
  made.value.origin = origin;
  const std::int64_t frame = sweep_.frames[static_cast<std::size_t>(at_[0])];
  if (name == "frame") {
    made.value.kind = JsonValue::Kind::Integer;
    made.value.integer = frame;
    made.value.number = static_cast<double>(frame);
  } else if (name == "time") {
    made.value.kind = JsonValue::Kind::Number;
    made.value.number = static_cast<double>(frame - sweep_.frames.front()) / fps_;
  } else {
    const std::string format = name.substr(std::string("frame:").size());
    const bool good = !format.empty() && format.size() <= 2 &&
                      std::all_of(format.begin(), format.end(), [](char c) { return c >= '0' && c <= '9'; });
    if (!good) {
      diagnostics_.add(origin, where, reference + " has a format that is unknown",
                       "write \"${frame:04}\" for at least four digits");
      return nullptr;
    }
    made.value.kind = JsonValue::Kind::String;
    made.value.text = *frameText(std::stoi(format));
  }
  return &ofFrame_.emplace(name, std::move(made)).first->second;
}

const Expanded* Variables::resolve(Variable& variable) {
  if (variable.state == State::Resolved) return &variable.expanded;
  if (variable.state == State::Broken) return nullptr;
  const std::string where = "vars." + variable.setting.name;
  if (variable.state == State::Resolving || stack_.size() >= kDeepest) {
    std::string loop;
    const auto first = std::find(stack_.begin(), stack_.end(), &variable);
    for (auto it = first; it != stack_.end(); ++it) loop += (*it)->setting.name + " → ";
    if (first == stack_.end())
      diagnostics_.add(variable.setting.origin, where, "variables are nested more than 64 deep",
                       "nest them less");
    else
      diagnostics_.add(variable.setting.origin, where,
                       "the variable needs itself: " + loop + variable.setting.name,
                       "give one of them a value of its own");
    variable.state = State::Broken;
    return nullptr;
  }
  variable.state = State::Resolving;
  stack_.push_back(&variable);
  auto expanded = expand(variable.setting.value, where, variable.setting.scope);
  stack_.pop_back();
  if (variable.state == State::Broken || !expanded) {
    variable.state = State::Broken;
    return nullptr;
  }
  variable.expanded = std::move(*expanded);
  if (variable.wedge > 0) variable.expanded.reads |= std::uint64_t{1} << variable.wedge;
  variable.state = State::Resolved;
  return &variable.expanded;
}

std::optional<Expanded> Variables::expand(const JsonValue& value, const std::string& where,
                                          const std::string& scope) {
  if (value.kind == JsonValue::Kind::String) return expandText(value, where, scope);
  Expanded result{value, value.origin.source};
  for (JsonValue& item : result.value.items) {
    auto expanded = expand(item, where, scope);
    if (!expanded) return std::nullopt;
    item = std::move(expanded->value);
    result.reads |= expanded->reads;
  }
  for (JsonMember& member : result.value.members) {
    auto expanded = expand(member.value, where, scope);
    if (!expanded) return std::nullopt;
    member.value = std::move(expanded->value);
    result.reads |= expanded->reads;
  }
  return result;
}

/// The environment and what the program sets itself.
const Expanded* Variables::fromOutside(const std::string& name) {
  if (const auto known = outside_.find(name); known != outside_.end()) return &known->second;
  auto keep = [&](const std::string& text, const std::filesystem::path& directory) {
    const auto source = std::make_shared<const Source>(Source{"${" + name + "}", directory});
    return &outside_.emplace(name, Expanded{parseTyped(text, source), source}).first->second;
  };
  if (name == "ASSETS") {
    if (environment_.assets.empty()) return nullptr;
    const Expanded* assets = keep(environment_.assets.string(), environment_.assets);
    return assets;
  }
  if (const auto text = environment_.variable(name)) return keep(*text, environment_.currentDirectory);
  return nullptr;
}

const Expanded* Variables::lookUp(const std::string& name, const Origin& origin, const std::string& where,
                                  const std::string& scope) {
  const std::string base = name.substr(0, name.find(':'));
  const std::string reference = inQuotes("${" + name + "}");
  if (base == "frame" || name == "time") return fromFrame(name, reference, origin, where);
  if (base != name) {
    diagnostics_.add(origin, where, reference + " has a format", "only ${frame} takes one");
    return nullptr;
  }
  if (const auto found = variables_.find(scope + name); found != variables_.end())
    return resolve(found->second);
  if (const Expanded* value = fromOutside(name)) return value;
  if (name == "ASSETS") {
    diagnostics_.add(origin, where, "the folder of assets was not found",
                     "set the environment variable SHERD_ASSETS");
    return nullptr;
  }
  diagnostics_.add(
      origin, where,
      (scope.empty() ? "there is no variable " : "the subgraph has no variable ") + inQuotes(name),
      remedyFor(name, scope));
  return nullptr;
}

/// What to do about a variable that is not there.
std::string Variables::remedyFor(const std::string& name, const std::string& scope) const {
  constexpr std::size_t kMostSuggestions = 100;  // each compares with all names
  if (!scope.empty() && variables_.contains(name))
    return "that of the graph is not seen inside: add " + inQuotes(name) +
           " to the subgraph's \"vars\" and pass it with \"params\": { " + inQuotes(name) + ": " +
           inQuotes("${" + name + "}") + " }";
  if (diagnostics_.count() >= kMostSuggestions) return "define it in \"vars\"";
  std::vector<std::string> names{"ASSETS", "frame", "time"};
  for (const auto& [known, variable] : variables_)
    if (known.starts_with(scope) && known.find('/', scope.size()) == std::string::npos)
      names.push_back(known.substr(scope.size()));
  return suggestion(name, names, "variables");
}

/// Puts a variable's value into the middle of a text.
bool Variables::append(Expanded& result, const std::string& name, const JsonValue& value,
                       const std::string& where) {
  const auto text = scalarText(value);
  if (!text) {
    diagnostics_.add(
        result.value.origin, where,
        "the variable " + inQuotes(name) + " is " + kindName(value.kind) + " and can't be part of a text",
        "it would have to stand alone: " + inQuotes("${" + name + "}"));
    return false;
  }
  result.value.text += *text;
  if (result.value.text.size() <= kLongestText) return true;
  diagnostics_.add(result.value.origin, where, "the text grows longer than 65536 bytes", "");
  return false;
}

std::optional<Expanded> Variables::expandText(const JsonValue& value, const std::string& where,
                                              const std::string& scope) {
  const std::string& text = value.text;
  Expanded result{value, value.origin.source};
  if (text.find("${") == std::string::npos) return result;
  result.value.text.clear();
  result.value.typed.reset();
  for (std::size_t at = 0; at < text.size();) {
    if (text.compare(at, 3, "$${") == 0) {
      result.value.text += "${";
      at += 3;
      continue;
    }
    if (text.compare(at, 2, "${") != 0) {
      result.value.text += text[at++];
      continue;
    }
    const std::size_t end = text.find('}', at);
    if (end == std::string::npos) {
      diagnostics_.add(value.origin, where, "a \"${\" is not closed", "it would have to end in }");
      return std::nullopt;
    }
    const std::string name = text.substr(at + 2, end - at - 2);
    const Expanded* found = lookUp(name, value.origin, where, scope);
    if (found == nullptr) return std::nullopt;
    if (at == 0 && found->base != nullptr) result.base = found->base;
    result.reads |= found->reads;
    if (at == 0 && end + 1 == text.size()) {
      result.value = found->value;
      result.value.origin = value.origin;
      return result;
    }
    if (!append(result, name, found->value, where)) return std::nullopt;
    at = end + 1;
  }
  return result;
}

}  // namespace sherd
