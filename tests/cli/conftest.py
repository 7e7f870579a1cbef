import pytest

from rubgen.cli import main


@pytest.fixture
def run(capsys):
    """Runs the command line; gives exit code, stdout, stderr."""

    def run(*arguments):
        with pytest.raises(SystemExit) as ended:
            main(list(arguments))
        output = capsys.readouterr()
        return ended.value.code, output.out, output.err

    return run
