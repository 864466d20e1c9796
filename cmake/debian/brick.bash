# Completion of brick(1) in bash: commands, their options, names of benches, boards, plants and set-ups.
_brick() {
  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} command=${COMP_WORDS[1]} words=
  local share=/usr/share/brick
  names() { local file; for file in "$share/$1"/*; do file=${file##*/}; echo "${file%.*}"; done; }
  case $before in
    --engine) words="rtl systemc lockstep" ;;
    --board) words=$(names boards) ;;
    --plant) words="none $(names plants)" ;;
    --load) words=$(names setups) ;;
    run | timing) [[ $word == -* ]] || words=$(brick list 2>/dev/null | sed -n 's/^\([a-z0-9-]\+\) .*/\1/p') ;;
    brick) words="list run exec console serve control timing boards plot regress cpu --help --version" ;;
  esac
  if [[ -z $words && $word == -* ]]; then
    words=$(brick "$command" --help 2>/dev/null | grep -o -E -- '--[a-z-]+' | sort -u)
  fi
  unset -f names
  mapfile -t COMPREPLY < <(compgen -W "$words" -- "$word")
  [[ ${#COMPREPLY[@]} -gt 0 ]] || compopt -o default
}
complete -F _brick brick
