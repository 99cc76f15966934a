// Nodes that take time, fail, hang and write files, for tests of the whole program under faults. Each says in
// a log file that it ran.
#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <stdexcept>
#include <thread>

#include "base/atomic_file.h"
#include "export/owned_files.h"
#include "plugin/plugin.h"

namespace faults {

/// Bytes that are worth keeping on disk.
struct Bytes {
  static constexpr const char* typeName = "FaultBytes";
  static constexpr int archiveVersion = 1;
  std::string text;
};
inline void hashValue(sherd::Hasher& hasher, const Bytes& bytes) { hasher.add(std::string_view(bytes.text)); }
inline std::size_t byteSize(const Bytes& bytes) { return sizeof bytes + bytes.text.size(); }
inline void saveValue(sherd::ArchiveWriter& to, const Bytes& bytes) { to.text(bytes.text); }
inline std::optional<Bytes> loadValue(sherd::ArchiveReader& from, std::type_identity<Bytes>) {
  return Bytes{from.text()};
}

/// Too big for the memory that is left, when it is hashed, saved or loaded.
struct Heavy {
  static constexpr const char* typeName = "FaultHeavy";
  static constexpr int archiveVersion = 1;
  enum class When : std::uint8_t { Hashed, Saved, Loaded } when = When::Hashed;
};
inline void hashValue(sherd::Hasher& hasher, const Heavy& heavy) {
  if (heavy.when == Heavy::When::Hashed) throw std::bad_alloc();
  hasher.add(static_cast<int>(heavy.when));
}
inline std::size_t byteSize(const Heavy& heavy) { return sizeof heavy; }
inline void saveValue(sherd::ArchiveWriter& to, const Heavy& heavy) {
  if (heavy.when == Heavy::When::Saved) throw std::bad_alloc();
  to.put(heavy.when);
}
inline std::optional<Heavy> loadValue(sherd::ArchiveReader&, std::type_identity<Heavy>) {
  throw std::bad_alloc();
}

}  // namespace faults

namespace {

using faults::Bytes;
using sherd::failure;
using sherd::NodeBuilder;
using sherd::NodeIo;
using sherd::NodeType;
using sherd::Result;

/// What every node here has: who it is, and the file that it says so in.
struct Logged {
  std::string name;
  std::string log;
};

template <class P>
NodeBuilder<P> loggedNode(const char* type, const char* help) {
  NodeBuilder<P> node(type, 1, help);
  node.text("name", &P::name, "what the log calls it").text("log", &P::log, "path of the log; empty: none");
  return node;
}

/// One line, by one call of the system: a kill leaves no half of it.
Result<void> logRun(const Logged& params) {
  if (params.log.empty()) return {};
  const int file = ::open(params.log.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  const std::string line = params.name + '\n';
  const bool written =
      file >= 0 && ::write(file, line.data(), line.size()) == static_cast<ssize_t>(line.size());
  if (file >= 0) ::close(file);
  return written ? Result<void>() : failure("cannot write the log '" + params.log + "'");
}

/// False where it was cancelled.
bool sleepFor(double ms, const sherd::Exec& exec) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double, std::milli>(ms);
  while (std::chrono::steady_clock::now() < end) {
    if (exec.cancelled()) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return true;
}

/// `size` bytes that depend on all of `seed`.
std::string bytesFrom(std::string_view seed, std::size_t size) {
  std::string text;
  for (sherd::Digest digest = sherd::checksum128(seed.data(), seed.size()); text.size() < size;
       digest = sherd::checksum128(&digest, sizeof digest))
    text += digest.hex();
  text.resize(size);
  return text;
}

struct WorkParams : Logged {
  double ms = 5;
  std::int64_t size = 1000, seed = 0;
};

NodeType workNode() {
  using P = WorkParams;
  return loggedNode<P>("Work", "Takes its time to make bytes of its inputs.")
      .optionalInput<Bytes>("a", "bytes")
      .optionalInput<Bytes>("b", "bytes")
      .number("ms", &P::ms, {.unit = "ms", .min = 0, .help = "how long it takes"})
      .integer("size", &P::size, {.min = 0, .help = "how many bytes it makes"})
      .integer("seed", &P::seed, {.help = "changes the bytes"})
      .output<Bytes>("bytes", "the bytes")
      .run([](const P& params, NodeIo& io) -> Result<void> {
        SHERD_CHECK(logRun(params));
        if (!sleepFor(params.ms, io.exec())) return sherd::cancelledError();
        std::string seed = std::to_string(params.seed) + ' ' + params.name;
        for (const char* port : {"a", "b"})
          if (const auto input = io.in<Bytes>(port)) seed += '|' + input->text;
        io.out<Bytes>("bytes", {bytesFrom(seed, static_cast<std::size_t>(params.size))});
        return {};
      });
}

struct WriteParams : Logged {
  std::string directory;
  std::int64_t count = 5, size = 20000;
  double ms = 2;
};

Result<void> writeFiles(const WriteParams& params, NodeIo& io) {
  SHERD_CHECK(logRun(params));
  SHERD_CHECK(sherd::makeDirectory(params.directory));
  std::vector<std::string> names;
  for (std::int64_t i = 1; i <= params.count; ++i)
    names.push_back("piece_" + std::to_string(i) + "_crack.obj");
  SHERD_ASSIGN(const sherd::OwnedFiles files, sherd::OwnedFiles::open(params.directory, names));
  SHERD_CHECK(files.claim());
  const auto input = io.in<Bytes>("bytes");
  std::vector<sherd::Digest> digests;
  for (const std::string& name : names) {
    if (!sleepFor(params.ms, io.exec())) return sherd::cancelledError();
    const std::string content = bytesFrom(name + input->text, static_cast<std::size_t>(params.size));
    SHERD_CHECK(sherd::writeFileAtomically(files.path(name), content));
    digests.push_back(sherd::checksum128(content.data(), content.size()));
    io.wrote(files.path(name));
  }
  SHERD_CHECK(files.commit(digests));
  io.wrote(files.path(sherd::OwnedFiles::manifestName));
  return {};
}

NodeType writeFilesNode() {
  using P = WriteParams;
  return loggedNode<P>("WriteFiles", "Writes several files that it owns.")
      .input<Bytes>("bytes", "what the files are made of")
      .outputDirectory("directory", &P::directory, "where they go")
      .integer("count", &P::count, {.min = 0, .help = "how many files"})
      .integer("size", &P::size, {.min = 0, .help = "bytes of each"})
      .number("ms", &P::ms, {.unit = "ms", .min = 0, .help = "how long each takes"})
      .writesFiles()
      .run(writeFiles);
}

struct FailParams : Logged {
  enum class How { Error, Exception, Number } how = How::Exception;
};

NodeType failNode() {
  using P = FailParams;
  return loggedNode<P>("Fail", "Fails.")
      .optionalInput<Bytes>("after", "what it waits for")
      .choice("how", &P::how,
              {{"error", P::How::Error}, {"exception", P::How::Exception}, {"number", P::How::Number}},
              "by an error, an exception, or an exception that is none of the library's")
      .output<Bytes>("bytes", "never")
      .run([](const P& params, NodeIo&) -> Result<void> {
        SHERD_CHECK(logRun(params));
        if (params.how == P::How::Exception) throw std::runtime_error("the bottom fell out");
        if (params.how == P::How::Number) throw 7;
        return failure("this never works", "use another node");
      });
}

struct HangParams : Logged {
  bool hard = false;
};

NodeType hangNode() {
  using P = HangParams;
  return loggedNode<P>("Hang", "Ends when it is cancelled, or after 20 s.")
      .boolean("hard", &P::hard, "don't even end when cancelled")
      .output<Bytes>("bytes", "nothing")
      .run([](const P& params, NodeIo& io) -> Result<void> {
        SHERD_CHECK(logRun(params));
        const sherd::Exec deaf;
        sleepFor(20000, params.hard ? deaf : io.exec());
        return failure("nobody stopped it");
      });
}

struct AllocateParams : Logged {
  double gigabytes = 100;
};

NodeType allocateNode() {
  using P = AllocateParams;
  return loggedNode<P>("Allocate", "Asks for a lot of memory.")
      .number("gigabytes", &P::gigabytes, {.unit = "GB", .min = 0, .help = "how much"})
      .output<Bytes>("bytes", "that much")
      .run([](const P& params, NodeIo& io) -> Result<void> {
        SHERD_CHECK(logRun(params));
        io.out<Bytes>("bytes", {std::string(static_cast<std::size_t>(params.gigabytes * 1e9), 'x')});
        return {};
      });
}

struct HeavyParams : Logged {
  faults::Heavy::When when = faults::Heavy::When::Hashed;
};

NodeType heavyNode() {
  using P = HeavyParams;
  using When = faults::Heavy::When;
  return loggedNode<P>("MakeHeavy", "Takes 5 ms to make a value that there is too little memory for.")
      .choice("when", &P::when, {{"hashed", When::Hashed}, {"saved", When::Saved}, {"loaded", When::Loaded}},
              "what the memory doesn't suffice for")
      .output<faults::Heavy>("heavy", "the value")
      .run([](const P& params, NodeIo& io) -> Result<void> {
        SHERD_CHECK(logRun(params));
        sleepFor(5, io.exec());
        io.out<faults::Heavy>("heavy", {params.when});
        return {};
      });
}

NodeType useHeavyNode() {
  using P = WorkParams;
  return loggedNode<P>("UseHeavy", "Takes a heavy value.")
      .input<faults::Heavy>("heavy", "the value")
      .integer("seed", &P::seed, {.help = "is what comes out"})
      .output<std::int64_t>("seed", "the seed")
      .run([](const P& params, NodeIo& io) -> Result<void> {
        io.out<std::int64_t>("seed", params.seed);
        return logRun(params);
      });
}

struct AddParams {
  double offset = 0;
};

NodeType addNode() {
  return NodeBuilder<AddParams>("Add", 1, "Adds two numbers.")
      .optionalInput<double>("a", "a number")
      .number("offset", &AddParams::offset, {.help = "is added"})
      .output<double>("sum", "a + offset")
      .run([](const AddParams& params, NodeIo& io) -> Result<void> {
        const auto a = io.in<double>("a");
        io.out<double>("sum", (a ? *a : 0) + params.offset);
        return {};
      });
}

struct WideParams : Logged {};
constexpr int kWide = 10'000;

NodeType wideNode() {
  NodeBuilder<WideParams> node = loggedNode<WideParams>("Wide", "Adds ten thousand numbers.");
  for (int i = 0; i < kWide; ++i) node.input<double>("n" + std::to_string(i), "a number");
  return node.output<double>("sum", "of all").run([](const WideParams& params, NodeIo& io) -> Result<void> {
    double sum = 0;
    for (int i = 0; i < kWide; ++i) sum += *io.in<double>("n" + std::to_string(i));
    const Logged line{params.name + ' ' + std::to_string(static_cast<std::int64_t>(sum)), params.log};
    SHERD_CHECK(logRun(line));
    io.out<double>("sum", sum);
    return {};
  });
}

}  // namespace

SHERD_NODE_PACK(workNode, writeFilesNode, failNode, hangNode, allocateNode, heavyNode, useHeavyNode, addNode,
                wideNode)
