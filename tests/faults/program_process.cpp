#include "faults/program_process.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <nlohmann/json.hpp>
#include <thread>

namespace sherd::faults {
namespace {

int openAnew(const std::string& path) {
  return ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
}

int exitCodeOf(int status) { return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status); }

}  // namespace

Process::Process(const std::vector<std::string>& arguments, const std::string& scratch,
                 const std::string& packs, const std::function<void()>& prepare) {
  static std::atomic<int> count{0};
  outFile_ = scratch + "/said." + std::to_string(count) + ".out";
  errFile_ = scratch + "/said." + std::to_string(count++) + ".err";
  std::vector<std::string> words{SHERD_BINARY_DIR "/bin/sherd"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  const int in = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
  const int out = openAnew(outFile_), err = openAnew(errFile_);
  pid_ = ::fork();
  if (pid_ == 0) {
    if (prepare) prepare();
    ::setenv("SHERD_NODE_PATH", packs.c_str(), 1);
    ::dup2(in, STDIN_FILENO);
    ::dup2(out, STDOUT_FILENO);
    ::dup2(err, STDERR_FILENO);
    ::execv(argv[0], argv.data());
    ::_exit(127);
  }
  for (const int file : {in, out, err}) ::close(file);
  EXPECT_GT(pid_, 0);
}

Process::~Process() {
  if (pid_ <= 0) return;
  ::kill(pid_, SIGKILL);
  ::waitpid(pid_, nullptr, 0);
}

void Process::signal(int number) const { ::kill(pid_, number); }

Ended Process::wait(double seconds) {
  const auto start = std::chrono::steady_clock::now();
  int status = 0;
  while (::waitpid(pid_, &status, WNOHANG) == 0) {
    if (secondsSince(start) > seconds) {
      ADD_FAILURE() << "still running after " << seconds << " s";
      ::kill(pid_, SIGKILL);
    }
    sleepSeconds(0.0005);
  }
  pid_ = -1;
  Ended ended{exitCodeOf(status), contentOf(outFile_), contentOf(errFile_)};
  fs::remove(outFile_);
  fs::remove(errFile_);
  return ended;
}

Ended runSherd(const std::vector<std::string>& arguments, const std::string& scratch,
               const std::string& packs, const std::function<void()>& prepare) {
  return Process(arguments, scratch, packs, prepare).wait();
}

std::map<std::string, std::string> statesIn(const std::string& events) {
  std::map<std::string, std::string> states;
  std::istringstream lines(events);
  for (std::string line; std::getline(lines, line) && !lines.eof();) {
    const auto event = nlohmann::json::parse(line, nullptr, false);
    if (!event.is_object()) {
      ADD_FAILURE() << "no JSON: " << line;
      continue;
    }
    const std::string kind = event.value("event", "");
    if (kind == "node" || kind == "plan") states[event.value("name", "")] = event.value("state", "");
  }
  return states;
}

std::set<std::string> namesIn(const std::map<std::string, std::string>& states, const std::string& state) {
  std::set<std::string> names;
  for (const auto& [name, is] : states)
    if (is == state) names.insert(name);
  return names;
}

void expectSameFiles(const std::map<std::string, std::string>& files,
                     const std::map<std::string, std::string>& expected, const std::string& when) {
  for (const auto& [name, content] : expected) {
    ASSERT_TRUE(files.contains(name)) << name << " is missing, " << when;
    EXPECT_TRUE(files.at(name) == content) << name << " differs, " << when;
  }
  for (const auto& [name, content] : files)
    EXPECT_TRUE(expected.contains(name)) << name << " is stray, " << when;
}

std::vector<std::string> linesOf(const std::string& path) {
  std::istringstream text(contentOf(path));
  std::vector<std::string> lines;
  for (std::string line; std::getline(text, line);) lines.push_back(line);
  return lines;
}

void writeText(const std::string& path, const std::string& text) {
  std::ofstream out(path, std::ios::binary);
  out << text;
  out.close();
  EXPECT_TRUE(out) << path;
}

void sleepSeconds(double seconds) { std::this_thread::sleep_for(std::chrono::duration<double>(seconds)); }

bool waitUntil(const std::function<bool()>& done) {
  for (const auto start = std::chrono::steady_clock::now(); secondsSince(start) < 10; sleepSeconds(0.001))
    if (done()) return true;
  return false;
}

double secondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

Weave::Weave(const ScratchDirectory& scratch, const std::map<std::string, std::string>& more, double ms)
    : root_(scratch.file("weave")) {
  fs::create_directories(root_);
  std::string nodes;
  const auto add = [&](const std::string& name, const std::string& type, const std::string& in,
                       const std::string& params) {
    nodes += "    \"" + name + R"(": {"type": ")" + type + R"(@1", "in": {)" + in +
             R"(}, "params": {"name": ")" + name + R"(", "log": ")" + file("log") + "\", " + params + "}},\n";
  };
  const auto work = [&](const std::string& name, const std::string& in) {
    add(name, "Work", in, "\"ms\": " + std::to_string(ms) + ", \"size\": 100000");
  };
  for (const char* name : {"a0", "a1", "a2", "a3"}) work(name, "");
  work("b0", R"("a": "a0", "b": "a1")");
  work("b1", R"("a": "a1", "b": "a2")");
  work("b2", R"("a": "a2", "b": "a3")");
  work("c0", R"("a": "b0", "b": "b1")");
  work("c1", R"("a": "b1", "b": "b2")");
  work("d0", R"("a": "c0", "b": "c1")");
  add("left", "WriteFiles", R"("bytes": "c0")", R"("directory": "${out}/left", "ms": 1)");
  add("right", "WriteFiles", R"("bytes": "d0")", R"("directory": "${out}/right", "count": 7, "ms": 1)");
  std::string rest;
  for (const auto& [name, body] : more) {
    nodes += "    \"" + name + "\": {" + body + "},\n";
    rest += (rest.empty() ? "\"" : ", \"") + name + '"';
  }
  const std::string targets = R"("targets": {"files": ["left", "right"])" +
                              (rest.empty() ? "" : ", \"rest\": [" + rest + "]") + "},\n";
  writeText(file("graph.json"),
            R"({"format": 1, "vars": {"out": "out"}, )" + targets + "  \"nodes\": {\n" + nodes + "}}\n");
}

std::vector<std::string> Weave::run(const std::vector<std::string>& more, const std::string& cache) const {
  std::vector<std::string> words{"run", file("graph.json"), "--json"};
  if (cache.empty())
    words.push_back("--no-cache");
  else
    words.insert(words.end(), {"--cache", fs::path(cache).is_absolute() ? cache : file(cache)});
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

Ended Weave::runToEnd(const std::vector<std::string>& more, const std::string& cache) const {
  return runSherd(run(more, cache), root_);
}

std::map<std::string, std::string> Weave::undisturbed(const std::vector<std::string>& more) const {
  std::vector<std::string> words = more;
  words.insert(words.end(), {"--var", "out=" + file("undisturbed")});
  fs::remove_all(file("undisturbed"));
  const Ended ended = runToEnd(words, "");
  EXPECT_EQ(ended.exitCode, 0) << ended.out << ended.err;
  auto files = filesBelow(file("undisturbed"));
  EXPECT_EQ(files.size(), 5u + 7 + 2);
  return files;
}

std::map<std::string, std::string> Weave::outputs() const { return filesBelow(file("out")); }

void Weave::startAnew() const {
  for (const char* name : {"out", "cache", "log"}) fs::remove_all(file(name));
}

}  // namespace sherd::faults
