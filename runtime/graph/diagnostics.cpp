#include "graph/diagnostics.h"

#include <algorithm>
#include <map>
#include <tuple>

namespace sherd {

std::string Origin::text() const {
  if (source == nullptr) return {};
  if (line == 0) return source->name;
  return source->name + ':' + std::to_string(line) + ':' + std::to_string(column);
}

std::string Diagnostic::text() const {
  std::string text = origin.text();
  if (!text.empty()) text += ": ";
  if (!where.empty()) text += where + ": ";
  return text + error.text();
}

void Diagnostics::add(Origin origin, std::string where, std::string what, std::string remedy) {
  add(std::move(origin), std::move(where), Error{std::move(what), std::move(remedy), {}, Error::Kind::Input});
}

void Diagnostics::add(Origin origin, std::string where, Error error) {
  if (origin.line > 0) {
    const std::string leaf = where.substr(where.rfind('/') + 1);  // all of it where there is no /
    if (!seen_.insert(origin.text() + '\n' + leaf + '\n' + error.text()).second) return;
  }
  ++count_;
  if (kept_.size() < kMostKept) kept_.push_back({std::move(origin), std::move(where), std::move(error)});
}

std::vector<Diagnostic> Diagnostics::sorted() const {
  std::map<const Source*, std::size_t> order;
  for (const Diagnostic& d : kept_)
    if (d.origin.line > 0) order.emplace(d.origin.source.get(), order.size() + 1);
  auto place = [&](const Diagnostic& d) {
    return std::tuple(d.origin.line > 0 ? order.at(d.origin.source.get()) : 0, d.origin.line,
                      d.origin.column);
  };
  std::vector<Diagnostic> all = kept_;
  std::stable_sort(all.begin(), all.end(),
                   [&](const Diagnostic& a, const Diagnostic& b) { return place(a) < place(b); });
  return all;
}

}  // namespace sherd
