#include "cli/usage.h"

#include <algorithm>

#include "graph/suggest.h"

namespace sherd {
namespace {

Error wrong(std::string what, std::string remedy) {
  return Error{std::move(what), std::move(remedy), {}, Error::Kind::Input};
}

bool isOption(const std::string& argument) { return argument.starts_with('-'); }

bool isVerb(const std::string& word) {
  return std::find(verbNames().begin(), verbNames().end(), word) != verbNames().end();
}

const std::string kVerbs =
    "the verbs are run, plan, check, fmt, upgrade, nodes and cache; `sherd --help` explains them";

}  // namespace

const std::vector<std::string>& verbNames() {
  static const std::vector<std::string> names{"run", "plan", "check", "fmt", "upgrade", "nodes", "cache"};
  return names;
}

Result<void> checkVerbName(const std::vector<std::string>& arguments) {
  for (const char* sufficient : {"--version", "--help", "-h"})
    if (std::find(arguments.begin(), arguments.end(), sufficient) != arguments.end()) return {};
  if (arguments.empty()) return wrong("sherd needs a verb", kVerbs);
  const std::string& word = arguments.front();
  if (isVerb(word)) return {};
  if (isOption(word)) return wrong(inQuotes(word) + " stands where a verb belongs", kVerbs);
  if (word.ends_with(".json"))
    return wrong(inQuotes(word) + " is no verb", "did you mean `sherd run " + word + "`?");
  const std::string near = closest(word, verbNames());
  return wrong("there is no verb " + inQuotes(word),
               near.empty() ? kVerbs : "did you mean " + inQuotes(near) + "? " + kVerbs);
}

Error missingGraph(const std::string& verb) {
  return wrong(verb + " needs a graph file", "e.g. sherd " + verb + " graphs/first_fracture.json");
}

Error unexpectedArgument(const std::string& verb, const std::string& argument,
                         const std::vector<std::string>& options) {
  const std::string help = "`sherd " + verb + " --help` lists what it takes";
  if (!isOption(argument)) return wrong(verb + " doesn't take " + inQuotes(argument), help);
  const std::string near = closest(argument.substr(0, argument.find('=')), options);
  return wrong(verb + " has no option " + inQuotes(argument),
               near.empty() ? help : "did you mean " + inQuotes(near) + "?");
}

bool asksForEvents(const std::vector<std::string>& arguments) {
  if (std::find(arguments.begin(), arguments.end(), "--json") == arguments.end()) return false;
  return arguments.front() == "run" || !isVerb(arguments.front());
}

}  // namespace sherd
