# What `cmake --install` puts below the prefix. The program finds its library, its node pack and its assets from where it
# stands, so the tree may be moved.
include(CMakePackageConfigHelpers)

set_target_properties(sherd_options PROPERTIES EXPORT_NAME options)
set_target_properties(sherd_graph PROPERTIES EXPORT_NAME graph INSTALL_RPATH "$ORIGIN")
set_target_properties(sherd_types PROPERTIES EXPORT_NAME types INSTALL_RPATH "$ORIGIN")
set_target_properties(sherd_nodes PROPERTIES INSTALL_RPATH "$ORIGIN")
set_target_properties(sherd PROPERTIES INSTALL_RPATH "$ORIGIN/../lib")

install(TARGETS sherd sherd_nodes RUNTIME DESTINATION bin LIBRARY DESTINATION lib)
install(TARGETS sherd_graph sherd_types sherd_options EXPORT sherdTargets LIBRARY DESTINATION lib
        INCLUDES DESTINATION include/sherd)

# What a node includes, by the same names as within this tree.
file(GLOB base_headers CONFIGURE_DEPENDS runtime/base/*.h)
file(GLOB types_headers CONFIGURE_DEPENDS nodes/types/*.h)
list(FILTER types_headers EXCLUDE REGEX "/scalar_grid_vdb\\.h$")  # needs OpenVDB, which a pack may do without
install(FILES ${base_headers} DESTINATION include/sherd/base)
install(FILES runtime/graph/migration.h runtime/graph/node_type.h runtime/graph/registry.h runtime/graph/value.h
        DESTINATION include/sherd/graph)
install(FILES runtime/plugin/plugin.h DESTINATION include/sherd/plugin)
install(FILES ${types_headers} DESTINATION include/sherd/types)

install(DIRECTORY assets/ DESTINATION share/sherd/assets PATTERN "*.py" EXCLUDE)
install(DIRECTORY graphs/ DESTINATION share/sherd/graphs FILES_MATCHING PATTERN "*.json" PATTERN out EXCLUDE)
install(FILES LICENSE README.md DESTINATION share/doc/sherd)
install(FILES nodes/README.md DESTINATION share/doc/sherd RENAME nodes.md)

# The handshake wants the very version.
configure_package_config_file(runtime/package/sherdConfig.cmake.in ${PROJECT_BINARY_DIR}/sherdConfig.cmake
                              INSTALL_DESTINATION lib/cmake/sherd)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/sherdConfigVersion.cmake COMPATIBILITY ExactVersion)
install(EXPORT sherdTargets NAMESPACE sherd:: DESTINATION lib/cmake/sherd)
install(FILES ${PROJECT_BINARY_DIR}/sherdConfig.cmake ${PROJECT_BINARY_DIR}/sherdConfigVersion.cmake
              runtime/package/node_pack.cmake DESTINATION lib/cmake/sherd)
