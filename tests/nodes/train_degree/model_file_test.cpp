// What was learned, written to a file and read from it.
#include "train_degree/model_file.h"

#include <filesystem>
#include <fstream>

#include "nodes/train_degree/block.h"
#include "support/program.h"

namespace sherd {
namespace {

namespace fs = std::filesystem;

const DegreeModel& learned(DegreeMethod method) {
  static const auto make = [](DegreeMethod m) {
    const Body body = block();
    TrainDegreeParams params = small();
    params.learn.method = m;
    return valueOf(trainDegree(body.tets, body.embedding, nullptr, params, Exec{})).model;
  };
  static const DegreeModel process = make(DegreeMethod::Process), network = make(DegreeMethod::Network);
  return method == DegreeMethod::Process ? process : network;
}

Digest contentOf(const DegreeModel& model) {
  Hasher hasher;
  hashValue(hasher, model);
  return hasher.digest();
}

std::string errorOf(const Result<DegreeModel>& model) { return model.ok() ? "" : model.error().text(); }

TEST(ModelFile, IsReadAsItWasWritten) {
  const ScratchDirectory directory;
  for (const DegreeMethod method : {DegreeMethod::Process, DegreeMethod::Network}) {
    const ModelFileParams at{directory.file("deep/er.model")};
    ASSERT_TRUE(writeModel(learned(method), at, Exec{}).ok());
    const DegreeModel read = valueOf(readModel(at, Exec{}));
    EXPECT_EQ(contentOf(read), contentOf(learned(method)));
    EXPECT_EQ(differences(read.validFor, learned(method).validFor), "");
    EXPECT_EQ(modelBytes(read), modelBytes(learned(method)));
  }
}

TEST(ModelFile, EveryDamagedByteIsSeen) {
  const std::string bytes = modelBytes(learned(DegreeMethod::Network));
  ASSERT_TRUE(modelFrom(bytes).ok());
  for (std::size_t i = 0; i < bytes.size(); i += 1 + bytes.size() / 997) {
    std::string damaged = bytes;
    damaged[i] = static_cast<char>(damaged[i] ^ 1 << i % 8);
    EXPECT_FALSE(modelFrom(damaged).ok()) << i;
    EXPECT_FALSE(modelFrom(std::string_view(bytes).substr(0, i)).ok()) << i;
  }
  EXPECT_FALSE(modelFrom(bytes + '0').ok());
}

TEST(ModelFile, SaysWhatIsWrong) {
  const auto has = [](const std::string& text, const char* part) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  std::string bytes = modelBytes(learned(DegreeMethod::Network));
  has(errorOf(modelFrom("")), "no model of WriteModel");
  has(errorOf(modelFrom(bytes.substr(0, 30))), "cut short");
  bytes[bytes.size() / 2] ^= 4;
  has(errorOf(modelFrom(bytes)), "damaged");
  bytes.replace(0, bytes.find('\n'), "sherd DegreeModel 0");
  has(errorOf(modelFrom(bytes)), "another version");

  const ScratchDirectory directory;
  const std::string place = fs::path(directory.file("any")).parent_path().string();
  has(errorOf(readModel({place}, Exec{})), "is a folder");
  has(errorOf(readModel({place + "/none.model"}, Exec{})), "no such file");
  std::ofstream(place + "/text.model") << "hello";
  has(errorOf(readModel({place + "/text.model"}, Exec{})), "text.model: this is no model");
  const Result<void> written = writeModel(learned(DegreeMethod::Network), {place}, Exec{});
  ASSERT_FALSE(written.ok());
  EXPECT_EQ(written.error().port, "file");
}

}  // namespace
}  // namespace sherd
