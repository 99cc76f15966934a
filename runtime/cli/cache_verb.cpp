#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "cli/cache_size.h"
#include "cli/usage.h"
#include "cli/verbs.h"
#include "eval/disk_store.h"
#include "graph/suggest.h"

namespace sherd {
namespace {

const std::vector<std::string> kActions{"stat", "gc", "verify", "clear"};

int refuse(const Error& error, Console& console, ExitCode code) {
  Diagnostics diagnostics;
  diagnostics.add({}, error.port, error);
  printDiagnostics(diagnostics, console.err);
  return code;
}

Error unknownAction(const std::string& action) {
  const std::string all = "cache takes stat, gc, verify or clear";
  if (action.empty()) return Error{"cache needs to know what to do", all, {}, Error::Kind::Input};
  const std::string near = closest(action, kActions);
  return Error{"cache can't " + inQuotes(action),
               near.empty() ? all : "did you mean " + inQuotes(near) + "? " + all,
               {},
               Error::Kind::Input};
}

void printStat(const DiskStore& store, Console& console) {
  const DiskStoreStats stats = store.stats();
  console.out << "cache in " << shownPath(store.directory()) << '\n'
              << fmt::format("  values   {:>9}  {}\n", stats.objects, sizeText(stats.objectBytes))
              << fmt::format("  results  {:>9}  {}\n", stats.records, sizeText(stats.recordBytes))
              << fmt::format("  {} of at most {}\n", sizeText(stats.bytes()), sizeText(stats.mostBytes));
}

int verify(DiskStore& store, Console& console) {
  const std::vector<std::string> lines = store.verify();
  for (const std::string& line : lines) console.out << line << '\n';
  if (lines.empty())
    console.out << "all is sound\n";
  else
    console.out << countText(lines.size(), "file") << " of the cache " << (lines.size() == 1 ? "was" : "were")
                << " damaged; what is lost will be computed again\n";
  return kOk;
}

int act(const CacheOptions& options, std::uint64_t mostBytes, DiskStore& store, Console& console) {
  if (options.action == "stat") {
    printStat(store, console);
  } else if (options.action == "gc") {
    const std::uint64_t freed = store.collect(mostBytes);
    console.out << "freed " << sizeText(freed) << "; " << sizeText(store.stats().bytes())
                << " are left of at most " << sizeText(mostBytes) << '\n';
  } else if (options.action == "verify") {
    return verify(store, console);
  } else {
    if (const auto cleared = store.clear(); !cleared.ok())
      return refuse(cleared.error(), console, kNodeFailed);
    console.out << "cleared the cache in " << shownPath(store.directory()) << '\n';
  }
  return kOk;
}

}  // namespace

int cacheVerb(const CacheOptions& options, const Environment& environment, Console& console) {
  if (std::find(kActions.begin(), kActions.end(), options.action) == kActions.end())
    return refuse(unknownAction(options.action), console, kWrongInput);
  DiskStoreOptions storeOptions;
  storeOptions.onWarning = [&](const std::string& text) { console.err << "warning: " << text << '\n'; };
  const auto most = cacheSize(options.max, "--max", environment);
  if (!most.ok()) return refuse(most.error(), console, kWrongInput);
  storeOptions.mostBytes = *most;
  std::string directory = options.directory;
  if (directory.empty()) directory = DiskStore::defaultDirectory(environment.variable);
  if (directory.empty())
    return refuse(Error{"there is no directory for the cache: none of the environment variables SHERD_CACHE, "
                        "XDG_CACHE_HOME and HOME is set",
                        "name one with --cache",
                        {},
                        Error::Kind::Input},
                  console, kWrongInput);
  directory = (environment.currentDirectory / directory).string();
  std::error_code problem;
  if (!std::filesystem::exists(directory, problem)) {
    console.out << "there is no cache in " << shownPath(directory) << '\n';
    return kOk;
  }
  const auto store = DiskStore::open(directory, std::move(storeOptions));
  if (!store.ok()) return refuse(store.error(), console, kWrongInput);
  return act(options, *most, **store, console);
}

}  // namespace sherd
