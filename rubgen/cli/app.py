"""The application: all commands, and the completion of shells."""

import sys
from typing import Annotated, Literal

from cyclopts import App

from rubgen import __version__
from rubgen.cli.declarations import begin, checking, learning, making, pictures, single_run
from rubgen.cli.options import option

app = App(
    name="rubgen",
    help="Labelled blade-rub data from a finite-element blisk in a flexible oval casing.",
    version=__version__,
    version_flags=["--version"],
    help_format="plaintext",
    suppress_keyboard_interrupt=False,
)
app.command(begin.list_offered, name="list")
for command in (
    begin.init,
    begin.plan,
    making.generate,
    making.resense,
    making.merge,
    making.push,
    single_run.simulate,
    single_run.replay,
    single_run.regenerate,
    single_run.modes,
    pictures.figure,
    pictures.report,
    pictures.browse,
    learning.features,
    learning.baseline,
    learning.export,
    checking.info,
    checking.label,
    checking.verify,
    checking.repair,
    checking.doctor,
):
    app.command(command)

_ZSH_END = """
if [[ "${funcstack[1]}" == "_rubgen" ]]; then
  _cyclopts_rubgen "$@"
else
  (( $+functions[compdef] )) || { autoload -Uz compinit && compinit; }
  compdef _cyclopts_rubgen rubgen
fi
"""
"""Lets the script be read in ~/.zshrc too; as the file _rubgen in $fpath it completes as well."""


@app.command
def completion(
    shell: Annotated[Literal["bash", "zsh", "fish", "powershell"], option("The shell that is to complete.")], /
) -> int:
    """Print a script by which a shell completes commands: eval "$(rubgen completion bash)" in ~/.bashrc."""
    sys.stdout.write(app.generate_completion(shell=shell))
    if shell == "zsh":  # what is printed so far works only from a file in $fpath
        sys.stdout.write(_ZSH_END)
    return 0
