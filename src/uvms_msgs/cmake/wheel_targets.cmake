# Where ROS 2 comes from PyPI wheels, the imported *__rosidl_generator_py targets still name include
# directories of the machine that built the wheels, and CMake refuses to generate with them. Drop
# every include directory that is not there, once all packages have been found. In an ordinary ROS
# installation all of them exist, and nothing changes.
function(uvms_drop_missing_include_directories)
  get_directory_property(imported IMPORTED_TARGETS)
  foreach(target IN LISTS imported)
    get_target_property(directories ${target} INTERFACE_INCLUDE_DIRECTORIES)
    if(NOT directories)
      continue()
    endif()
    set(present "")
    foreach(directory IN LISTS directories)
      if(directory MATCHES "\\$<" OR EXISTS "${directory}")
        list(APPEND present "${directory}")
      endif()
    endforeach()
    if(NOT present STREQUAL directories)
      set_property(TARGET ${target} PROPERTY INTERFACE_INCLUDE_DIRECTORIES "${present}")
    endif()
  endforeach()
endfunction()

cmake_language(DEFER CALL uvms_drop_missing_include_directories)
