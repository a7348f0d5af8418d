from dataclasses import dataclass
from pathlib import Path
from typing import List

import yaml
from ament_index_python.packages import get_package_share_directory


@dataclass(frozen=True)
class Goal:
    x: float
    y: float
    name: str = ''

    def __str__(self) -> str:
        return f'{self.name or "goal"} ({self.x}, {self.y})'


def load() -> List[Goal]:
    path = Path(get_package_share_directory('student_turtles')) / 'config' / 'goals.yaml'
    with open(path) as file:
        return [Goal(**each) for each in yaml.safe_load(file)['goals']]
