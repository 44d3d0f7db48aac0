"""The picture docs/fmpy_gui.png: FMPy's own interface with the braking manoeuvre, without a screen.

    python3 -m venv gui && gui/bin/python -m pip install 'FMPy[gui,plot]==0.3.32' && gui/bin/python tools/fmpy_gui.py

PySide6 takes 1 GB: hence an environment of its own. What the script does, one does by hand: open the FMU, set
slip_source to 2, choose results/braking_inputs.csv as input (of `make demo`: FMPy's interface wants a column for every
input) and 20 s as the end, tick outputs, simulate.
"""

import os
import sys
from pathlib import Path

os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")
# The page of the documentation is drawn by Chromium, which asks for a user other than root.
os.environ.setdefault("QTWEBENGINE_DISABLE_SANDBOX", "1")

from fmpy.gui.MainWindow import MainWindow
from PySide6.QtCore import QSettings
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication

REPOSITORY = Path(__file__).resolve().parent.parent
# From the repository, so that the picture shows no more of this machine's folders.
FMU, TABLE, PICTURE = "results/WheelRailContact.fmu", "results/braking_inputs.csv", "docs/fmpy_gui.png"
START_VALUES = {"slip_source": "2"}
PLOTTED = ["traction_force", "peak_temperature", "worn_volume"]
STOP, INTERVAL = "20", "0.005"  # s
DRAWN = 8000  # ms


def main():
    """Open, set, simulate, and keep what the window shows."""
    os.chdir(REPOSITORY)
    QSettings.setPath(QSettings.Format.NativeFormat, QSettings.Scope.UserScope, str(REPOSITORY / "target" / "qt"))
    application = QApplication(sys.argv[:1])
    window = MainWindow()
    window.resize(1200, 720)
    window.show()
    window.load(FMU)
    window.startValues |= START_VALUES
    window.ui.inputCheckBox.setChecked(True)
    window.ui.inputFilenameLineEdit.setText(TABLE)
    window.stopTimeLineEdit.setText(STOP)
    window.ui.outputIntervalRadioButton.setChecked(True)
    window.ui.outputIntervalLineEdit.setText(INTERVAL)
    window.selectedVariables.clear()
    for name in PLOTTED:
        window.selectVariable(window.variables[name])
    window.startSimulation()
    while window.simulationThread is not None:
        application.processEvents()
    window.ui.treeView.scrollToBottom()
    # The curves are drawn by a browser within, in its own time.
    QTest.qWait(DRAWN)
    window.grab().save(PICTURE)
    print(f"wrote {PICTURE}")


if __name__ == "__main__":
    main()
