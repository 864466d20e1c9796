# brick_add_firmware(NAME turbo SOURCES ... LINKER_SCRIPT firmware.ld): cross-compiles an ELF image for rv32imc.
find_program(RISCV_GCC riscv64-unknown-elf-gcc REQUIRED)
set(BRICK_FIRMWARE_FLAGS -march=rv32imc -mabi=ilp32 -std=c11 -O2 -ffreestanding -fno-common -ffunction-sections
    -fdata-sections -Wall -Wextra -Werror -Wconversion -g)
function(brick_add_firmware)
  cmake_parse_arguments(F "" "NAME;LINKER_SCRIPT" "SOURCES" ${ARGN})
  set(objects "")
  foreach(source ${F_SOURCES})
    get_filename_component(absolute ${source} ABSOLUTE)
    string(REPLACE "/" "_" object ${source})
    set(object ${CMAKE_CURRENT_BINARY_DIR}/${F_NAME}/${object}.o)
    add_custom_command(OUTPUT ${object}
      COMMAND ${RISCV_GCC} ${BRICK_FIRMWARE_FLAGS} -I${CMAKE_SOURCE_DIR} -MMD -MF ${object}.d -c ${absolute}
              -o ${object}
      DEPENDS ${absolute} DEPFILE ${object}.d COMMENT "RV32 ${source}" VERBATIM)
    list(APPEND objects ${object})
  endforeach()
  get_filename_component(script ${F_LINKER_SCRIPT} ABSOLUTE)
  set(elf ${CMAKE_BINARY_DIR}/bin/${F_NAME}.elf)
  add_custom_command(OUTPUT ${elf}
    COMMAND ${RISCV_GCC} -march=rv32imc -mabi=ilp32 -nostdlib -Wl,--gc-sections -T ${script} ${objects} -lgcc -o ${elf}
    DEPENDS ${objects} ${script} COMMENT "RV32 link ${F_NAME}.elf" VERBATIM)
  add_custom_target(firmware_${F_NAME} ALL DEPENDS ${elf})
  # For variants of it in tests.
  set_target_properties(firmware_${F_NAME} PROPERTIES FIRMWARE_OBJECTS "${objects}" FIRMWARE_SCRIPT ${script})
endfunction()
