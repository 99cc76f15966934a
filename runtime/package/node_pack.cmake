# sherd_add_node_pack(NAME sources…): a node pack NAME_nodes.so (or NAME.so where NAME ends in _nodes), found by sherd
# in the directories on SHERD_NODE_PATH. It may include base/, graph/, plugin/ and types/.
function(sherd_add_node_pack NAME)
  add_library(${NAME} MODULE ${ARGN})
  target_link_libraries(${NAME} PRIVATE sherd::graph sherd::types)
  set_target_properties(${NAME} PROPERTIES PREFIX "" SUFFIX ".so" CXX_EXTENSIONS OFF)
  if(NOT NAME MATCHES "_nodes$")
    set_target_properties(${NAME} PROPERTIES OUTPUT_NAME ${NAME}_nodes)
  endif()
endfunction()
