#!/usr/bin/env python3
"""What is made of the program's own table of commands and options: manual pages, completion in bash, zsh and fish, and
the page docs/reference.md. `cagewright describe` is that table.

reference.py PROGRAM --out FOLDER     man1/, completions/ and reference.md in FOLDER
reference.py PROGRAM --renew PAGE     writes docs/reference.md
reference.py PROGRAM --check PAGE     1 if the page is not what the program says
"""

import argparse
import difflib
import gzip
import json
import pathlib
import re
import subprocess
import sys

FILES = "file"  # the kind of an argument that is a file


def described(program):
    said = subprocess.run([program, "describe"], capture_output=True, text=True, check=True)
    return json.loads(said.stdout)


def kind_of(option):
    """"" for a switch, FILES, "words" or "value"."""
    if not option["type"] and not option["positional"]:
        return ""
    if choices_of(option):
        return "words"
    # A number or a text of its own; else what is not described otherwise is the name of a file.
    name = option["text"] or option["type"]
    is_text = option["names"] and re.match(r"(INT|FLOAT|COUNT|PERCENT|NUMBER|SIZE|TIME|SECONDS|UINT)", name)
    return "value" if is_text else FILES


def choices_of(option):
    return [word for word in option["words"] if not word.isupper()]


def text_of(option):
    """Value and default of a text such as "NAME [mean_value]" or "TIME=1h"."""
    found = re.match(r"(?P<value>[^\[=]*?)(?:=(?P<one>.*)| \[(?P<other>.*)\])?$", option["text"])
    return (found["value"], found["one"] or found["other"] or "") if found else (option["text"], "")


def value_of(option):
    """What stands after the name: PERCENT, FILE, "a|b|c"."""
    if not kind_of(option):
        return ""
    if option["text"]:
        return text_of(option)[0]
    if option["words"]:
        return "|".join(option["words"])
    limits = re.search(r"in \[(\S+) - (\S+)\]", option["type"])
    kind = option["type"].split(":")[0]
    name = {"INT": "COUNT", "UINT": "COUNT", "FLOAT": "NUMBER"}.get(kind, kind)
    if name == "TEXT" and re.search(r"\bfile\b|to write|picture|weights", option["help"]):
        name = "FILE"
    return f"{name} ({limits[1]} to {limits[2]})" if limits else name


def default_of(option):
    default = text_of(option)[1] or option["default"]
    return "" if default in ("[]", '""') or (option["text"] and not text_of(option)[1]) else default


def positionals(command):
    return [option for option in command["options"] if option["positional"]]


def named(command):
    return [option for option in command["options"] if option["names"] and not option["positional"]]


def grouped(command):
    groups = {}
    for option in named(command):
        groups.setdefault(option["group"], []).append(option)
    return groups


def synopsis(command):
    words = []
    for option in positionals(command):
        word = option["positional"].upper() + ("..." if option["many"] else "")
        words.append(word if option["required"] else f"[{word}]")
    for option in named(command):
        if option["required"]:
            words.append(f"{option['names'][0]} {value_of(option)}")
    return " ".join(words + ["[OPTIONS]"])


# ---- docs/reference.md


def cell(text):
    return text.replace("|", "\\|").replace("<", "&lt;").replace("*", "\\*").replace("\n", " ")


def option_rows(options):
    yield "| option | | default |"
    yield "|---|---|---|"
    for option in options:
        names = ", ".join(f"`{name}`" for name in option["names"])
        value = value_of(option)
        needed = " *Needed.*" if option["required"] else ""
        default = f"`{cell(default_of(option))}`" if default_of(option) else ""
        yield f"| {names}{' ' + cell(value) if value else ''} | {cell(option['help'])}{needed} | {default} |"
    yield ""


def markdown(table):
    lines = ["# Every command and option", "",
             "This page is made of the program's own table (`tools/reference.py`), as are `--help`, the manual pages and the completion in",
             "shells. Lengths that take per cent are parts of the diagonal of the model's bounding box.", ""]
    lines += ["| command | |", "|---|---|"]
    for command in table["commands"]:
        lines.append(f"| [`{command['name']}`](#{command['name']}) | {cell(command['help'])} |")
    lines += ["", "Before or after any command:", ""]
    lines += option_rows(named(table))
    for command in table["commands"]:
        lines += [f"## {command['name']}", "", f"{command['help']}.", "",
                  "```text", f"cagewright {command['name']} {synopsis(command)}", "```", ""]
        if positionals(command):
            lines += ["| argument | |", "|---|---|"]
            for option in positionals(command):
                lines.append(f"| `{option['positional'].upper()}` | {cell(option['help'])} |")
            lines.append("")
        for group, options in grouped(command).items():
            options = [option for option in options if "--help" not in option["names"]]
            if options:
                lines += ([f"**{group}**", ""] if group != "Options" else []) + list(option_rows(options))
    codes = re.findall(r"^\s+(\d+)\s+(.*)$", table["footer"], re.M)
    lines += ["## Exit codes", "", "| exit code | means |", "|--:|---|"]
    lines += [f"| {code} | {cell(meaning)} |" for code, meaning in codes]
    return "\n".join(lines) + "\n"


# ---- manual pages


def roff(text):
    text = text.replace("\\", "\\e").replace("-", "\\-")
    return re.sub(r"^(?=[.'])", r"\\&", text, flags=re.M)


def man_options(options):
    for option in options:
        names = ", ".join(f"\\fB{roff(name)}\\fR" for name in option["names"])
        value = value_of(option)
        default = f" Default: {default_of(option)}." if default_of(option) else ""
        needed = " Needed." if option["required"] else ""
        help_text = option["help"] + ("" if option["help"].endswith(".") else ".")
        yield ".TP"
        yield names + (f" \\fI{roff(value)}\\fR" if value else "")
        yield roff(help_text + needed + default)


def man_head(title, table):
    return [f'.TH {title.upper()} 1 "" "cagewright {table["version"]}" "User Commands"', ".SH NAME"]


def man_overview(table):
    lines = man_head("cagewright", table)
    lines += ["cagewright \\- build cages round 3D models and deform models with them", ".SH SYNOPSIS",
              ".B cagewright", "\\fICOMMAND\\fR [\\fIOPTIONS\\fR]", ".SH DESCRIPTION",
              roff("A cage is a coarse closed mesh round a model: moving its vertices deforms the model. cagewright makes a cage "
                   "by itself, proves that it is valid, binds the model to it, and moves the model as the cage moves."),
              ".SH COMMANDS"]
    for command in table["commands"]:
        lines += [".TP", f"\\fBcagewright\\-{command['name']}\\fR(1)", roff(command["help"]) + "."]
    lines += [".SH OPTIONS", "These may stand before or after the command."]
    lines += man_options(named(table))
    lines.append(".SH EXIT STATUS")
    for code, meaning in re.findall(r"^\s+(\d+)\s+(.*)$", table["footer"], re.M):
        lines += [".TP", f"\\fB{code}\\fR", roff(meaning)]
    lines += [".SH EXAMPLES", ".nf", roff("cagewright generate armadillo.off -o cage.obj --vertices 60"),
              roff("cagewright deform armadillo.off cage.obj posed_cage.obj -o posed.obj"), ".fi",
              ".SH SEE ALSO"]
    lines.append(", ".join(f"\\fBcagewright\\-{command['name']}\\fR(1)" for command in table["commands"]))
    return "\n".join(lines) + "\n"


def man_command(table, command):
    name = f"cagewright-{command['name']}"
    lines = man_head(name, table)
    first = command["help"].split(". ")[0]
    lines += [f"{roff(name)} \\- {roff(first[0].lower() + first[1:])}", ".SH SYNOPSIS",
              f".B cagewright {command['name']}", roff(synopsis(command)), ".SH DESCRIPTION", roff(command["help"]) + "."]
    if positionals(command):
        lines.append(".SH ARGUMENTS")
        for option in positionals(command):
            lines += [".TP", f"\\fI{roff(option['positional'].upper())}\\fR", roff(option["help"]) + "."]
    for group, options in grouped(command).items():
        lines.append(".SH OPTIONS" if group == "Options" else f".SS {roff(group)}")
        lines += man_options(options)
    lines += [".SH SEE ALSO", "\\fBcagewright\\fR(1)"]
    return "\n".join(lines) + "\n"


# ---- completion


def bash(table):
    words = " ".join(command["name"] for command in table["commands"])
    common = [name for option in named(table) for name in option["names"]]
    cases = []
    for command in table["commands"]:
        names = " ".join([name for option in named(command) for name in option["names"]] + common)
        cases.append(f"    {command['name']}) options='{names}' ;;")
    values = []
    for command in [table] + table["commands"]:
        for option in named(command):
            where = "*" if command is table else command["name"]
            for name in option["names"]:
                if kind_of(option) == "words":
                    values.append(f"    {where}:{name}) COMPREPLY=($(compgen -W '{' '.join(choices_of(option))}' -- \"$current\")); "
                                  "return ;;")
                elif kind_of(option) == "value":
                    values.append(f"    {where}:{name}) return ;;")
    return f"""# Completion of cagewright in bash, made by tools/reference.py.
_cagewright() {{
  local current=${{COMP_WORDS[COMP_CWORD]}} previous=${{COMP_WORDS[COMP_CWORD - 1]}} command= word options
  for word in "${{COMP_WORDS[@]:1:COMP_CWORD-1}}"; do
    case " {words} " in *" $word "*) command=$word; break ;; esac
  done
  COMPREPLY=()
  if [ -z "$command" ]; then
    mapfile -t COMPREPLY < <(compgen -W '{words} {" ".join(common)}' -- "$current")
    return
  fi
  case "$command:$previous" in
{chr(10).join(values)}
  esac
  case "$command" in
{chr(10).join(cases)}
  esac
  if [[ $current == -* ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$options" -- "$current")
  fi
}}
complete -o default -F _cagewright cagewright
"""


def zsh_text(text):
    return text.replace("'", "'\\''").replace("[", "\\[").replace("]", "\\]").replace(":", "\\:")


def zsh_option(option):
    names = option["names"]
    kind = kind_of(option)
    action = {"": "", "words": f":value:({' '.join(choices_of(option))})", "value": ":value: ", FILES: ":file:_files"}[kind]
    help_text = f"[{zsh_text(option['help'])}]"
    if len(names) > 1:
        return f"'({' '.join(names)})'{{{','.join(names)}}}'{help_text}{action}'"
    return f"'{names[0]}{help_text}{action}'"


def zsh(table):
    lines = ["#compdef cagewright", "# Made by tools/reference.py.", "", "_cagewright() {",
             "  local context state line", "  typeset -A opt_args", "  _arguments -C \\"]
    lines += [f"    {zsh_option(option)} \\" for option in named(table)]
    lines += ["    '1:command:->command' \\", "    '*::argument:->argument'", "  case $state in", "  command)",
              "    local -a commands", "    commands=("]
    for command in table["commands"]:
        lines.append(f"      '{command['name']}:{zsh_text(command['help'])}'")
    lines += ["    )", "    _describe command commands", "    ;;", "  argument)", "    case $words[1] in"]
    for command in table["commands"]:
        lines.append(f"    {command['name']})")
        lines.append("      _arguments \\")
        lines += [f"        {zsh_option(option)} \\" for option in named(command) + named(table)
                  if "--help" not in option["names"] or option in named(command)]
        lines += ["        '*:file:_files'", "      ;;"]
    lines += ["    esac", "    ;;", "  esac", "}", "", '_cagewright "$@"']
    return "\n".join(lines) + "\n"


def fish_text(text):
    return text.replace("\\", "\\\\").replace("'", "\\'")


def fish_option(option, condition):
    words = []
    for name in option["names"]:
        words.append(f"-l {name[2:]}" if name.startswith("--") else f"-s {name[1:]}")
    kind = kind_of(option)
    if kind == "words":
        words.append(f"-x -a '{' '.join(choices_of(option))}'")
    elif kind:
        words.append("-x" if kind == "value" else "-r")
    return f"complete -c cagewright {condition}{' '.join(words)} -d '{fish_text(option['help'])}'"


def fish(table):
    lines = ["# Completion of cagewright in fish, made by tools/reference.py."]
    lines += [fish_option(option, "") for option in named(table)]
    for command in table["commands"]:
        lines.append(f"complete -c cagewright -n __fish_use_subcommand -f -a {command['name']} -d '{fish_text(command['help'])}'")
        lines += [fish_option(option, f"-n '__fish_seen_subcommand_from {command['name']}' ") for option in named(command)
                  if "--help" not in option["names"]]
    return "\n".join(lines) + "\n"


def write_all(table, out):
    pages = out / "man1"
    completions = out / "completions"
    for folder in (pages, completions):
        folder.mkdir(parents=True, exist_ok=True)
    texts = {"cagewright": man_overview(table)}
    texts.update({f"cagewright-{command['name']}": man_command(table, command) for command in table["commands"]})
    for name, text in texts.items():
        (pages / f"{name}.1").write_text(text)
        (pages / f"{name}.1.gz").write_bytes(gzip.compress(text.encode(), 9, mtime=0))  # as packages have them
    (completions / "cagewright").write_text(bash(table))
    (completions / "_cagewright").write_text(zsh(table))
    (completions / "cagewright.fish").write_text(fish(table))
    (out / "reference.md").write_text(markdown(table))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    todo = parser.add_mutually_exclusive_group(required=True)
    todo.add_argument("--out", type=pathlib.Path)
    todo.add_argument("--renew", type=pathlib.Path)
    todo.add_argument("--check", type=pathlib.Path)
    arguments = parser.parse_args()
    table = described(arguments.program)
    if arguments.out:
        write_all(table, arguments.out)
    elif arguments.renew:
        arguments.renew.write_text(markdown(table))
    elif arguments.check.read_text() != markdown(table):
        print(*difflib.unified_diff(arguments.check.read_text().splitlines(), markdown(table).splitlines(), str(arguments.check),
                                    str(arguments.program), n=0, lineterm=""), sep="\n")
        sys.exit(f"{arguments.check} is not what the program says: run tools/reference.py {arguments.program} --renew "
                 f"{arguments.check}")


if __name__ == "__main__":
    main()
