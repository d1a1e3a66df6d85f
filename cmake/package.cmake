# `cpack` in the build folder makes a .deb for the system it runs on. The library versions that a program was built with are those of its
# system, so each Debian or Ubuntu release has a package of its own.

# Paints the icon.
add_executable(skerry_icon ${CMAKE_SOURCE_DIR}/tools/icon/main.cpp)
target_link_libraries(skerry_icon PRIVATE skerry_game)
set(icon_file ${CMAKE_BINARY_DIR}/generated/skerry.png)
add_custom_command(OUTPUT ${icon_file} COMMAND skerry_icon ${icon_file} DEPENDS skerry_icon COMMENT "Painting the icon" VERBATIM)

# Debian wants these compressed, without a time in them.
set(package_dir ${CMAKE_SOURCE_DIR}/package)
string(TIMESTAMP today "%Y-%m-%d" UTC)
string(TIMESTAMP debian_day "%a, %d %b %Y 00:00:00 +0000" UTC)
set(package_contact "The Skerry developers <skerry@localhost>")
configure_file(${package_dir}/changelog.in ${CMAKE_BINARY_DIR}/generated/changelog @ONLY)
function(add_compressed source)
  get_filename_component(name ${source} NAME)
  set(file ${CMAKE_BINARY_DIR}/generated/${name}.gz)
  add_custom_command(OUTPUT ${file} COMMAND sh -c "gzip -9nc '${source}' > '${file}'" DEPENDS ${source} VERBATIM)
  set(compressed_files ${compressed_files} ${file} PARENT_SCOPE)
endfunction()
add_compressed(${package_dir}/skerry.6)
add_compressed(${CMAKE_BINARY_DIR}/generated/changelog)
add_custom_target(skerry_package_files ALL DEPENDS ${icon_file} ${compressed_files})

# `skerry` runs `skerry_openvdb` and `skerry_openexr` from the folder that it lies in itself, so all lie in one, and a link leads there.
set(program_dir lib/skerry)
install(TARGETS skerry skerry_openexr RUNTIME DESTINATION ${program_dir})
if(SKERRY_OPENVDB)
  install(TARGETS skerry_openvdb RUNTIME DESTINATION ${program_dir})
endif()
file(CREATE_LINK ../${program_dir}/skerry ${CMAKE_BINARY_DIR}/generated/skerry_link SYMBOLIC)
install(FILES ${CMAKE_BINARY_DIR}/generated/skerry_link DESTINATION bin RENAME skerry)

configure_file(${package_dir}/skerry.metainfo.xml.in ${CMAKE_BINARY_DIR}/generated/org.skerry.Skerry.metainfo.xml @ONLY)
install(FILES ${CMAKE_BINARY_DIR}/generated/org.skerry.Skerry.metainfo.xml DESTINATION share/metainfo)
install(FILES ${package_dir}/org.skerry.Skerry.desktop DESTINATION share/applications)
install(FILES ${icon_file} DESTINATION share/icons/hicolor/256x256/apps RENAME org.skerry.Skerry.png)
install(FILES ${CMAKE_BINARY_DIR}/generated/skerry.6.gz DESTINATION share/man/man6)
install(FILES ${CMAKE_BINARY_DIR}/generated/changelog.gz DESTINATION share/doc/skerry)
install(FILES ${package_dir}/copyright DESTINATION share/doc/skerry)

set(CMAKE_SKIP_INSTALL_ALL_DEPENDENCY ON)  # of all targets; those above are what the package needs
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME skerry)
set(CPACK_PACKAGE_VENDOR "The Skerry developers")
set(CPACK_PACKAGE_CONTACT "${package_contact}")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "floating voxel islands, lit by a real sun")
set(CPACK_PACKAGE_DESCRIPTION "Walk, fly, dig and build on voxel islands that drift in the air, under a
physically based sky, and dark where no light reaches. Also draws pictures of
worlds and reads and writes OpenVDB files.")
set(CPACK_STRIP_FILES ON)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION games)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# What is loaded while it runs, which no linker knows of: Vulkan's loader, what GLFW asks the X server with, letters.
set(CPACK_DEBIAN_PACKAGE_DEPENDS "libvulkan1, libxcursor1, libxi6, libxinerama1, libxrandr2, fonts-dejavu-core")
# Chinese and Japanese need one of these fonts. Sound is loaded if it is there: without it the program is silent.
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "mesa-vulkan-drivers | vulkan-icd, libopenal1")
string(APPEND CPACK_DEBIAN_PACKAGE_RECOMMENDS ", fonts-wqy-microhei | fonts-wqy-zenhei | fonts-noto-cjk | fonts-droid-fallback")
set(CPACK_POST_BUILD_SCRIPTS ${CMAKE_SOURCE_DIR}/cmake/check_package.cmake)
include(CPack)
