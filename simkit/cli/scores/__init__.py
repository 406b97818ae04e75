"""Scores of files: how much of a file works as in Gazebo, and the table of all files of a folder.

`part_list` lists the parts of a world, `part_places` finds the part that a diagnostic belongs to, `score_calculation`
counts, and `file_score` has the result. `folder_search` finds the files of a folder, `isolated_scores` scores each file
in a process with limits. `score_text` and `score_page` show the results.
"""
