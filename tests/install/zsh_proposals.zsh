# What zsh proposes: zsh -f zsh_proposals.zsh SCRIPT 'toothpath run --' prints the words, a line each. A shell in a terminal of its own gets
# the line and a tab; every word that the completion adds is printed behind a mark.
zmodload zsh/zpty || exit 3
script=$1 line=$2 work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cp "$script" "$work/_toothpath"
cat >"$work/init" <<'EOF'
fpath=(${0:h} $fpath)
PROMPT=
autoload -U compinit
compinit -u -D
compadd() {
  if [[ ${@[1,(i)(-|--)]} == *-(O|A|D)\ * ]]; then builtin compadd "$@"; return; fi
  local -a words
  local word
  builtin compadd -A words "$@"
  for word in $words; do print -r -- "proposed:$word:"; done
  builtin compadd "$@"
}
propose() {
  zle complete-word
  print -r -- end-of-proposals
}
zle -N propose
bindkey '^I' propose
EOF
zpty shell zsh -f -i
zpty -w shell "source $work/init"
zpty -n -w shell "$line"$'\t'
while zpty -r shell output; do
  while read -r -d $'\n' word; do
    [[ $word != *proposed:*:* ]] || print -r -- ${${word#*proposed:}%%:*}
    [[ $word != *end-of-proposals* ]] || exit 0
  done <<<"$output"
done
exit 1
