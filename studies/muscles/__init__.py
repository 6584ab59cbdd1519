"""What stimulated muscles leave of the paper's gains: results/muscles.*"""
