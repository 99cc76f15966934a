#include <gtest/gtest.h>

#include "graph/node_type.h"
#include "surfaces.h"

namespace sherd {
NodeType tetrahedralizeNode();

namespace test {
namespace {

TEST(TetrahedralizeNode, GivesWhatTheFunctionGives) {
  const NodeType type = tetrahedralizeNode();
  EXPECT_EQ(type.name, "Tetrahedralize");
  const auto mesh = shared(sphere(Vec3::Zero(), 1));
  const Exec exec;
  NodeIo io(exec);
  io.setInput("mesh", Value::of<TriMesh>(mesh));
  const auto done = type.run({{"tets", std::int64_t{300}}, {"edge_length", 0.0}}, io);
  ASSERT_TRUE(done.ok()) << done.error().text();
  const auto direct = tetrahedralize(mesh, {.tets = 300}, exec);
  ASSERT_TRUE(direct.ok());
  const Value out = io.output("tets");
  EXPECT_EQ(out.digest(), Value::of<TetMesh>(std::make_shared<const TetMesh>(*direct)).digest());
}

}  // namespace
}  // namespace test
}  // namespace sherd
