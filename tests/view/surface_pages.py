"""Pages of surfaces for the browser tests: small terrains made here, and what is needed to look at them."""
import math
import os
import random
import subprocess


class Pages:
    def __init__(self, krepl, directory):
        self.krepl, self.directory = krepl, directory
        os.makedirs(directory, exist_ok=True)

    def path(self, name):
        return os.path.join(self.directory, name)

    def run(self, *arguments):
        return subprocess.run([self.krepl, *map(str, arguments)], check=True, capture_output=True, text=True).stdout

    def mesh(self, name, vertices, triangles):
        with open(self.path(name + ".off"), "w", encoding="ascii") as out:
            out.write(f"OFF\n{len(vertices)} {len(triangles)} 0\n")
            out.writelines(" ".join(map(str, v)) + "\n" for v in vertices)
            out.writelines("3 " + " ".join(map(str, t)) + "\n" for t in triangles)
        return self.path(name + ".off")

    def grid(self, name, columns, rows, height, first=(0, 0)):
        """A mesh over a grid of samples one apart."""
        vertices = [(first[0] + x, first[1] + y, height(x, y)) for y in range(rows) for x in range(columns)]
        triangles = []
        for y in range(rows - 1):
            for x in range(columns - 1):
                a = y * columns + x
                triangles += [(a, a + 1, a + columns + 1), (a, a + columns + 1, a + columns)]
        return self.mesh(name, vertices, triangles)

    def hills(self, name, side, seed=1, first=(0, 0)):
        rng = random.Random(seed)
        waves = [(rng.uniform(0.1, 0.6), rng.uniform(0.1, 0.6), rng.uniform(0, 6), rng.uniform(0.3, 1.2)) for _ in range(6)]
        return self.grid(name, side, side, lambda x, y: round(
            3 + sum(h * math.sin(a * x + b * y + c) for a, b, c, h in waves), 2), first)

    def page(self, name, mesh, radius, *arguments, result="json"):
        """The page of a surface, with the terrain; the name of the file, and what krepl says."""
        surface, page = self.path(f"{name}.{result}"), self.path(name + ".html")
        self.run("terrain", mesh, surface, "--radius", radius, "--quiet")
        said = self.run("view", surface, "-o", page, "--input", mesh, *arguments)
        return page, said

    def heights(self, mesh, radius, places):
        """What the drop cutter says: rows of text."""
        with open(self.path("at.csv"), "w", encoding="ascii") as out:
            out.write("x,y\n" + "".join(f"{x!r},{y!r}\n" for x, y in places))
        rows = self.run("height", mesh, "--radius", radius, "--at", self.path("at.csv"), "-o", "-", "--quiet")
        return [row.split(",") for row in rows.split()[1:]]
