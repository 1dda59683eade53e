# Fails if an object compiled for an instruction set defines a global symbol that other objects may define too: the linker
# keeps one copy, and a program on an old processor could be left with the AVX one, or a fast one with that of the baseline.
#   cmake -DNM=nm -DISA=avx2 "-DOBJECTS=a.o;b.o" -P cmake/check_symbols.cmake
# With -DELSEWHERE=ON the objects are others, and may define nothing of that instruction set.
string(LENGTH "${ISA}" length)
set(own "6cspace([0-9]+[a-z_]+)?${length}${ISA}")  # the mangled namespace cspace::<isa> or cspace::<room>::<isa>
set(leaks)
list(FILTER OBJECTS EXCLUDE REGEX "\\.[gp]ch$")  # precompiled headers are listed among the objects
foreach(object IN LISTS OBJECTS)
  execute_process(COMMAND ${NM} --extern-only --defined-only ${object} OUTPUT_VARIABLE symbols
                          RESULT_VARIABLE failed)
  if(failed OR (NOT ELSEWHERE AND NOT symbols MATCHES "${own}"))
    message(FATAL_ERROR "no symbols of cspace::${ISA} in ${object}")
  endif()
  string(REGEX MATCHALL "[^\n]+" symbols "${symbols}")
  foreach(symbol IN LISTS symbols)
    if(ELSEWHERE AND symbol MATCHES "${own}")
      list(APPEND leaks "${symbol} (${object})")
    elseif(NOT ELSEWHERE AND NOT symbol MATCHES "${own}|DW\\.ref\\.")
      list(APPEND leaks "${symbol} (${object})")
    endif()
  endforeach()
endforeach()
if(leaks)
  list(JOIN leaks "\n  " leaks)
  message(FATAL_ERROR "symbols outside their instruction set (${ISA}):\n  ${leaks}")
endif()
