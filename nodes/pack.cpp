// The node pack: one loadable plugin that registers every step.
#include "plugin/plugin.h"

namespace sherd {

NodeType loadMeshNode();
NodeType repairNode();
NodeType tetrahedralizeNode();
NodeType embedNode();
NodeType simulateNode();
NodeType readVdbNode();
NodeType weightsNode();
NodeType predictDegreeNode();
NodeType cvdNode();
NodeType tessellateNode();
NodeType exportCrackSurfaceNode();
NodeType previewNode();
NodeType contactSheetNode();

}  // namespace sherd

SHERD_NODE_PACK(sherd::loadMeshNode, sherd::repairNode, sherd::tetrahedralizeNode, sherd::embedNode,
                sherd::simulateNode, sherd::readVdbNode, sherd::weightsNode, sherd::predictDegreeNode,
                sherd::cvdNode, sherd::tessellateNode, sherd::exportCrackSurfaceNode, sherd::previewNode,
                sherd::contactSheetNode)
